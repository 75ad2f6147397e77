#include "losses/transport/sliced/line_transport.hpp"

#include <algorithm>
#include <numeric>

namespace bowstring::sliced {
namespace {

double squared_distance(const LineMeasure& a, const LineMeasure& b, const LineStep& step) {
  const double apart = a.position[step.i] - b.position[step.j];
  return apart * apart;
}

}  // namespace

LineMeasure sorted(Span<const double> position, Span<const double> mass) {
  LineMeasure out;
  out.place.resize(position.size());
  std::iota(out.place.begin(), out.place.end(), 0);
  std::stable_sort(out.place.begin(), out.place.end(), [&](int p, int q) {
    return position[static_cast<std::size_t>(p)] < position[static_cast<std::size_t>(q)];
  });
  for (const int place : out.place) {
    out.position.push_back(position[static_cast<std::size_t>(place)]);
    out.mass.push_back(mass[static_cast<std::size_t>(place)]);
  }
  return out;
}

std::vector<LineStep> staircase(const LineMeasure& a, const LineMeasure& b) {
  const std::size_t rows = a.mass.size(), columns = b.mass.size();
  std::vector<LineStep> steps;
  steps.reserve(rows + columns - 1);
  std::size_t i = 0, j = 0;
  double supply = a.mass[0], demand = b.mass[0];
  while (true) {
    // The last row gives what it has left, and the last column takes what comes: rounding of sums goes nowhere else.
    const bool last_row = i + 1 == rows, last_column = j + 1 == columns;
    const double mass = last_row && !last_column   ? demand
                        : last_column && !last_row ? supply
                                                   : std::min(supply, demand);
    steps.push_back({i, j, mass});
    if (last_row && last_column) return steps;
    supply -= mass;
    demand -= mass;
    if (last_column || (!last_row && supply <= demand)) {
      supply = a.mass[++i];
    } else {
      demand = b.mass[++j];
    }
  }
}

void staircase_potentials(const LineMeasure& a, const LineMeasure& b, const std::vector<LineStep>& steps,
                          std::vector<double>& u, std::vector<double>& v) {
  u.assign(a.place.size(), 0.0);
  v.assign(b.place.size(), 0.0);
  const auto of = [](std::vector<double>& potential, const LineMeasure& measure, std::size_t k) -> double& {
    return potential[static_cast<std::size_t>(measure.place[k])];
  };
  of(v, b, 0) = squared_distance(a, b, steps.front());
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const LineStep& step = steps[k];
    const double cost = squared_distance(a, b, step);
    if (step.i == steps[k - 1].i) {
      of(v, b, step.j) = cost - of(u, a, step.i);
    } else {
      of(u, a, step.i) = cost - of(v, b, step.j);
    }
  }
}

}  // namespace bowstring::sliced
