#pragma once

#include <string>
#include <vector>

#include "study/study_data.hpp"

namespace bowstring::study {

/// A formulation and what it costs to bring the first quantity within the target error of its reference.
struct Candidate {
  std::string label;        ///< "" where the study has a single formulation
  std::vector<int> choice;  ///< per axis of Recommendation::axes
  bool reaches = false;
  int mesh = -1;             ///< alternative of the axis of convergence; −1 without such an axis
  std::vector<int> runs;     ///< there, one for each case that the other axes give
  double error = 0.0;        ///< the largest among them
  double seconds = 0.0;      ///< of a solve, their mean
  int points = 0;            ///< meshes at which all cases count
  double least_error = 0.0;  ///< over all points
  int failures = 0, of = 0;  ///< runs
};

struct Recommendation {
  std::vector<int> axes;              ///< that tell formulations apart
  std::vector<Candidate> candidates;  ///< those that reach the target first, the fastest first
  std::string text, detail;           ///< "" without a reference
};

/// Work and precision. Formulations differ in the axes without numbers that state one problem (AxisData::problem) or,
/// where no such axis varies, in those of two to six numbers; the remaining ones give cases. A mesh of a formulation
/// counts where all of its cases with a known reference have converged and been timed; its error is the largest among
/// them. A formulation reaches the target at the fastest mesh from which on, at all finer ones that count, the error is
/// at most data.target_error. Nothing is interpolated: only runs that exist. Times within a factor of 1.2 are called
/// equal.
Recommendation recommend(const StudyData& data);

}  // namespace bowstring::study
