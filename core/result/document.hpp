#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"
#include "core/result/quantities.hpp"

namespace bowstring {

inline constexpr const char* bowstring_version = "0.1.0";

/// What a document says of a session, apart from it: the session may be solved again meanwhile.
struct SessionRecord {
  std::shared_ptr<const Scene> scene;
  std::string composition;  ///< resolved, JSON text
  std::string provenance;   ///< JSON text
  std::string solver;       ///< name
  ProblemSummary problem;
  std::vector<RowOrigin> rows;
  int epochs = 1;
  Seconds seconds;
};

/// `provenance` of a document as JSON text, which asks the registry for every plugin's file.
std::string provenance_json(const Session& session, const Registry& registry);

SessionRecord record_of(const Session& session, std::string provenance);

std::string result_document(const SessionRecord& session, const Solution& solution, const Readings& readings);

/// The small tables of the document alone, each as it stands there: `status`, `reason`, `certificate`, `energy`,
/// `quantities`.
std::string result_scalars(const SessionRecord& session, const Solution& solution, const Readings& readings);

/// The `bowstring.result/1` document as JSON text, numbers with 17 significant digits. `docs/results.md` describes
/// every key.
std::string result_document(const Session& session, const Solution& solution, const Readings& readings,
                            const Registry& registry);

}  // namespace bowstring
