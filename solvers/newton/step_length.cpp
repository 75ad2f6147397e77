#include "solvers/newton/step_length.hpp"

#include <algorithm>

namespace bowstring::newton {

double shortened(double step, const Status& trial, const Problem& problem) noexcept {
  constexpr double allowed = 0.45, least = 0.1, most = 0.7;  // the guard stands at half a clearance
  const double travelled = trial.code == Code::refused ? problem.travelled() : 0.0;
  return step * (travelled > 0.0 ? std::clamp(allowed / travelled, least, most) : 0.5);
}

}  // namespace bowstring::newton
