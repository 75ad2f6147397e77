#include "core/check/check.hpp"

#include <algorithm>

#include "core/check/derivatives.hpp"
#include "core/check/invariances.hpp"
#include "core/check/modes.hpp"
#include "core/check/scaling.hpp"
#include "core/check/states.hpp"

namespace bowstring {

const char* check_verdict_name(CheckVerdict verdict) noexcept {
  switch (verdict) {
    case CheckVerdict::ok:
      return "ok";
    case CheckVerdict::note:
      return "note";
    case CheckVerdict::failed:
      break;
  }
  return "FAILED";
}

CheckVerdict CheckReport::verdict() const noexcept {
  CheckVerdict worst = CheckVerdict::ok;
  for (const std::vector<CheckLine>* lines : {&derivatives, &invariances, &scaling, &modes}) {
    for (const CheckLine& line : *lines) worst = std::max(worst, line.verdict);
  }
  return worst;
}

CheckReport check(Assembly& assembly, const CheckOptions& options) {
  CheckReport report;
  checking::States states = checking::make_states(assembly, options.perturbed_states, options.seed);
  report.states = static_cast<int>(states.list.size());
  report.derivatives = std::move(states.lines);
  checking::check_derivatives(assembly, states.list, options, report);
  checking::check_invariances(assembly, states.list, options, report);
  checking::check_scaling(assembly, states.list, report);
  checking::check_modes(assembly, states.list, report);
  (void)checking::settle(assembly, assembly.scene().start_coordinates());
  return report;
}

}  // namespace bowstring
