#include "study/study_data.hpp"

#include <algorithm>
#include <cstddef>

namespace bowstring::study {

const char* spacing_name(Spacing spacing) noexcept {
  switch (spacing) {
    case Spacing::listed:
      return "listed";
    case Spacing::linear:
      return "linear";
    case Spacing::logarithmic:
      return "log";
    case Spacing::sampled:
      return "sampled";
  }
  return "";
}

int AxisData::largest() const noexcept {
  return numeric() ? static_cast<int>(std::max_element(number.begin(), number.end()) - number.begin()) : -1;
}

bool AxisData::same_problem(int one, int other) const noexcept {
  if (problem.empty() || one < 0 || other < 0) return true;
  return problem[static_cast<std::size_t>(one)] == problem[static_cast<std::size_t>(other)];
}

bool AxisData::has_cases() const noexcept {
  return std::any_of(problem.begin(), problem.end(), [this](int one) { return one != problem.front(); });
}

}  // namespace bowstring::study
