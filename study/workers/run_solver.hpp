#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/composition/recorded_state.hpp"
#include "core/interfaces/registry.hpp"
#include "study/plan/plan.hpp"
#include "study/store/run_record.hpp"

namespace bowstring::study {

/// What came of solving a run.
struct SolvedRun {
  RunRecord record;
  std::string document;                ///< "" where it was not asked for and no quantity needs it
  std::optional<CarriedState> result;  ///< what the next run of a warm chain starts from; empty unless converged
  bool stopped = false;                ///< `go_on` said no: this is not the run's result
  std::string problem;                 ///< why there is no result of the run that was planned; "" where there is
};

/// Solves one run in this process, `repeats` times. A composition that is refused is a record with that status.
/// `carried`: what it starts from; null: from cold. `with_document`: the document is wanted.
SolvedRun solve_run(const Plan& plan, int run, const CarriedState* carried, bool with_document, Registry& registry,
                    const std::function<bool()>& go_on);

/// The record of a run that no process survives.
RunRecord failed_run(const Plan& plan, int run, const std::string& reason);

/// The state of a stored result document, as `solve_run` hands it on: with the same bits. `why`: what is wrong with it.
std::optional<CarriedState> state_of_document(const std::string& document, std::string& why);

/// What names a quantity of interest in a record: its path, and its reduction.
std::string value_key(const QuantityOfInterest& quantity);

/// The number that a quantity has in a result document (as JSON text); empty where it has none. `why`: where the path
/// leads nowhere, what was wrong with it.
std::optional<double> quantity_in(const std::string& document, const QuantityOfInterest& quantity, std::string& why);

}  // namespace bowstring::study
