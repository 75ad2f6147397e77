#include "core/procedure/summary.hpp"

#include <limits>

namespace bowstring {

StateSummary summarise(Session& session, const Solution& solution) {
  StateSummary out;
  out.certificate = solution.certificate;
  for (const EnergyUse& use : session.scene->energies) out.energy_label.push_back(use.label);
  read_solution(session, solution, out.readings);
  return out;
}

double total_energy(const StateSummary& state) {
  if (state.readings.term_energy.size() != state.energy_label.size()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const double energy : state.readings.term_energy) sum += energy;
  return sum;
}

}  // namespace bowstring
