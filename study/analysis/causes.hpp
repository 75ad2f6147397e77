#pragma once

#include <string>
#include <vector>

#include "study/study_data.hpp"

namespace bowstring::study {

/// One of what is classified: a run, or a line.
struct Case {
  std::vector<int> choice;  ///< per axis of the study
  bool hit = false;         ///< it is of the kind that wants an explanation: failed, or does not settle
};

/// An axis has one of these alternatives.
struct Condition {
  int axis = 0;
  std::vector<int> alternatives;  ///< rising; −1: the axis has no part
};

/// What tells hits from the others.
struct Cause {
  std::vector<Condition> conditions;  ///< one or two that hold together; none where no axis tells enough
  int hits_with = 0, with = 0;        ///< cases for which they hold
  int hits_without = 0, without = 0;  ///< all others

  bool found() const noexcept { return !conditions.empty(); }
  bool pure() const noexcept { return found() && hits_with == with && hits_without == 0; }
};

/// The condition on one axis that explains most: the share of the hits that have it minus the share of the others that
/// do (Youden's index, Cancer 3:32, 1950; 1 is a pure split), at least 0.5. Two axes together only where they gain 0.1
/// on one: for each pair, the rectangle of alternatives found by taking turns. Among equals the first axis in the study
/// file. None where all or no cases are hits.
Cause find_cause(const std::vector<Case>& cases, const std::vector<int>& axes);

/// "anchoring = per-node", "N ≥ 320", "contact = a or b".
std::string condition_text(const AxisData& axis, const Condition& condition);
/// With " and " between.
std::string conditions_text(const StudyData& data, const std::vector<Condition>& conditions);

}  // namespace bowstring::study
