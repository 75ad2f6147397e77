#include "core/check/modes.hpp"

#include "core/check/rigid_modes.hpp"
#include "core/check/soft_modes.hpp"

namespace bowstring::checking {

void check_modes(Assembly& assembly, const std::vector<State>& states, CheckReport& report) {
  if (states.empty() || !settle(assembly, states.front().q).ok()) return;
  const std::vector<double>& q = states.front().q;
  RigidModes rigid = find_rigid_modes(assembly, q);
  report.modes = std::move(rigid.lines);
  for (CheckLine& line : find_soft_modes(assembly, q, rigid.rates)) report.modes.push_back(std::move(line));
}

}  // namespace bowstring::checking
