#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"
#include "core/session/refusal.hpp"
#include "study/plan/study_file.hpp"

namespace bowstring::study {

/// One run of a study, as it is to be solved.
struct PlannedRun {
  std::vector<int> choice;  ///< per axis the alternative
  std::string hash;         ///< what names its files; "" where the composition cannot be read
  std::string refusal;      ///< why it cannot be read, on one line; "" where it can
  int predecessor = -1;     ///< the run whose result it starts from; -1: from cold
};

/// Runs that one process solves, one after the other: a warm chain, or a single run.
struct Unit {
  std::vector<int> runs;
};

/// A study ready to run.
struct Plan {
  StudyFile study;
  std::vector<PlannedRun> runs;  ///< in the order of the product of the axes' groups, the last one fastest
  std::vector<Unit> units;       ///< of the runs that can be read
  /// Every library that the runs' compositions name, by "kind/name"; and "kernel". sha256.
  std::map<std::string, std::string> libraries;
};

/// The composition of a run, with the study's overrides and those of its alternatives.
CompositionRequest request_of(const StudyFile& study, const std::vector<int>& choice);

/// A refusal as the reason of a run: on one line, and without places and folders, which are those of a machine.
std::string refusal_reason(const StudyFile& study, const Refusal& refusal);

/// "T = 10 N, contact = node-wise-contact", for people.
std::string run_label(const StudyFile& study, const std::vector<int>& choice);

/// What the run would be told apart by if the study were read at this moment; "" where it cannot be read.
/// `read_just_now`: its composition, of the first state where it has several; null where there is none.
std::string hash_now(const Plan& plan, int run, const Composition* read_just_now, Registry& registry);

/// A run's choices, but -1 for the axis and those that are walked with it: what the runs along it have in common.
std::vector<int> without_walk(const StudyFile& study, std::vector<int> choice, int axis);

/// Reads every composition of the study. A value that no run can take is an error of the study, and so is what all runs
/// have in common; what only some combinations cannot take is a refused run. Empty where `refusal` has got something.
std::optional<Plan> make_plan(StudyFile study, Registry& registry, Refusal& refusal);

/// Looks for what else is wrong with a study whose file has errors: its paths and values, as far as they could be read.
void check_values(StudyFile study, Registry& registry, Refusal& refusal);

}  // namespace bowstring::study
