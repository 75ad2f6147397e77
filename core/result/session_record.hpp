#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result/quantities.hpp"

namespace bowstring {

/// What a document says of a session, apart from it: the session may be solved again meanwhile.
struct SessionRecord {
  std::shared_ptr<const Scene> scene;
  std::string composition;                 ///< resolved, JSON text
  std::string provenance;                  ///< JSON text
  std::string title, solver, enforcement;  ///< names
  ProblemSummary problem;
  std::vector<RowOrigin> rows;
  int epochs = 1;
  Seconds seconds;
};

}  // namespace bowstring
