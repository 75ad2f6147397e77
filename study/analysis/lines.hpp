#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/analysis/convergence.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// The runs of one formulation under one set of conditions.
struct Line {
  std::string label;                     ///< "per-node, T = 10 N"
  std::vector<int> choice;               ///< per line axis; -1 where the axis has no part
  std::vector<int> runs;                 ///< in the order of the axis that the line goes over, coarse to fine
  std::vector<std::optional<Fit>> fits;  ///< per quantity; empty ones without a numeric axis of convergence
};

struct Lines {
  int over = -1;          ///< the axis that lines go over: StudyData::along, or else the first numeric one; -1: none
  std::vector<int> axes;  ///< all others that have a choice, but sampled ones: a line holds them fixed
  std::vector<Line> lines;
};

/// Lines in the order of their first runs, each run in one of them. They are not fitted where a sample is in the study:
/// its points would follow each other along a line.
Lines find_lines(const StudyData& data);

bool sampled(const AxisData& axis);
/// Runs differ in it.
bool varies(const StudyData& data, int axis);

/// "anchoring = per-node"; "without anchoring" where the axis has no part.
std::string choice_text(const AxisData& axis, int alternative);
/// What tells an alternative in a list of several axes' ones: "per-node", "T = 10 N".
std::string short_choice_text(const AxisData& axis, int alternative);

/// The axes that vary.
std::vector<int> varying_axes(const StudyData& data);
/// "per-node, N = 40": a run's choices on the given axes in which it has a part; "baseline" where it has none.
std::string run_label(const StudyData& data, const std::vector<int>& axes, int run);

/// Per alternative of the axis of convergence, larger where finer: its number, or one over it where the runs' unknowns
/// fall as it rises; its index where it has no numbers above 0.
std::vector<double> resolutions(const StudyData& data);

/// The finest alternative of that axis at which at least half as many runs have converged as at any; −1 without such an
/// axis or runs. It is the one to tell sensitivities and distributions from.
int finest_mesh(const StudyData& data);
/// It is at the finest mesh, where there is one.
bool at_mesh(const StudyData& data, int run, int mesh);

/// Value of a quantity in a run that counts: a converged one; else NaN.
double counted_value(const StudyData& data, int quantity, int run);
/// NaN where there is none.
double reference_of(const StudyData& data, int quantity, int run);
/// Of whatever value a run has: relative to the reference, or absolute where that is 0; NaN where either is not known.
double relative_error(const StudyData& data, int quantity, int run);

}  // namespace bowstring::study
