#pragma once

#include <functional>
#include <string>

#include "core/result/quantities.hpp"

namespace bowstring {

/// A session that has been solved, with all that is said of it.
struct Solved {
  Solution solution;
  Readings readings;
  Status readable;       ///< not ok: what of the readings is unknown, and why; null in the document
  std::string document;  ///< JSON text of the `bowstring.result/1` document
};

/// Solves, certifies, reads the solution and writes its document. `progress` as in `solve`.
Solved solve_and_read(Session& session, const Registry& registry,
                      const std::function<bool(const IterationRecord&)>& progress);

}  // namespace bowstring
