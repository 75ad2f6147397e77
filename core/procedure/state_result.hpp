#pragma once

#include <string>
#include <vector>

#include "core/procedure/records.hpp"
#include "core/result/session_record.hpp"
#include "core/transport/curve_loss.hpp"

namespace bowstring {

/// A state that a composition asked for: what was solved, and what was found on the way.
struct StateResult {
  std::string name;  ///< of its [[step]]; "" without steps
  SessionRecord session;
  Solution solution;
  Readings readings;
  Status readable;                       ///< not ok: what of the readings is unknown, and why; null in the document
  std::vector<LossRecord> losses;        ///< without [[loss]] empty
  std::vector<std::string> input_files;  ///< absolute
  Path path;                             ///< without [continuation] empty
  std::vector<Equilibrium> equilibria;   ///< without [multistart] empty
};

/// Evaluates the losses of a state whose readings are there. One without a value is a warning of the solution.
void take_losses(const Composition& composition, const Scene& scene, StateResult& state);

}  // namespace bowstring
