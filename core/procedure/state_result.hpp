#pragma once

#include <string>
#include <vector>

#include "core/procedure/records.hpp"
#include "core/result/session_record.hpp"

namespace bowstring {

/// A state that a composition asked for: what was solved, and what was found on the way.
struct StateResult {
  std::string name;  ///< of its [[step]]; "" without steps
  SessionRecord session;
  Solution solution;
  Readings readings;
  Status readable;                       ///< not ok: what of the readings is unknown, and why; null in the document
  std::vector<std::string> input_files;  ///< absolute
  Path path;                             ///< without [continuation] empty
  std::vector<Equilibrium> equilibria;   ///< without [multistart] empty
};

}  // namespace bowstring
