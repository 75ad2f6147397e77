#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/recorded_state.hpp"
#include "core/result/provenance.hpp"
#include "core/session/start.hpp"

namespace bowstring {

/// What a result document says of the question that it answers.
struct RecordedResult {
  std::string text;         ///< the document itself, JSON
  std::string status;       ///< a verdict's name
  std::string composition;  ///< what was asked for, resolved, JSON text: with all its steps, before any walk
  Provenance provenance;    ///< the programs of all its states
  /// Where its first state started, if not at the composition's own start. Without a file: from memory.
  std::optional<StartOrigin> start;
  /// Of a run of a study that started from another run: the hash that names that run's files; else "".
  std::string predecessor;
};

/// Reads a `bowstring.result/1` document. `name` is what messages call it: "'result.json'". All that is wrong with it
/// is in `flaws`; then nothing of it is to be used.
RecordedResult read_result(std::string text, const std::string& name, std::vector<DocumentFlaw>& flaws);

}  // namespace bowstring
