#pragma once

#include <string>
#include <vector>

namespace bowstring {

inline constexpr const char* result_format = "bowstring.result/1";

/// Numbers that a result document holds under a name: those of a field, or the multipliers of a group of rows.
struct NamedNumbers {
  std::string name;      ///< "iliac.position"; "lumen"
  std::string manifold;  ///< of a field, "R^n", "S1", "S2", "SO3"; "" where the document does not say
  std::vector<double> values;
};

/// `state` of a result document: what another solve can start from.
struct RecordedState {
  std::vector<NamedNumbers> fields, multipliers;
  std::string sha256;  ///< of the document, "" of a state that was never written
};

/// What is wrong with a document, to be told with its name before and its place: "… has no 'state'".
struct DocumentFlaw {
  std::string found, expected, mend;
};

/// Reads the state of a result document, `bowstring.result/1`, as JSON text. `name` is what messages call the document:
/// "the start 'result.json'". Everything that is wrong with it is in `flaws`; then the state is not to be used.
RecordedState read_recorded_state(const std::string& text, const std::string& name, std::vector<DocumentFlaw>& flaws);

}  // namespace bowstring
