#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/interfaces/curve.hpp"

namespace bowstring {

inline constexpr const char* result_format = "bowstring.result/1";

/// Numbers that a result document holds under a name: those of a field, or the multipliers of a group of rows.
struct NamedNumbers {
  std::string name;      ///< "iliac.position"; "lumen"
  std::string manifold;  ///< of a field, "R^n", "S1", "S2", "SO3"; "" where the document does not say
  std::vector<double> values;
};

/// A curve as a result document shows it, whatever represented it: what another mesh, another kinematics or another
/// rest state is made from.
struct RecordedCurve {
  std::string name;
  CurveKind kind = CurveKind::vessel;
  std::string kinematics;                     ///< the plugin; "": not known
  int dimension = 0;                          ///< 0: not known
  std::vector<double> points;                 ///< nodes × dimension, mm
  std::vector<double> frames;                 ///< nodes × 4: quaternions, the mean of both edges' at inner nodes
  std::vector<double> share;                  ///< nodes: of the curve's material before each, from 0 to 1
  std::string along;                          ///< the vessel that a wire starts along; "": none
  double along_begin = 0.0, along_end = 0.0;  ///< … between these State 1 arc coordinates of it, mm
  std::vector<double> held_frame[2];          ///< quaternion of what a clamped end holds (Curve::held_frame), or empty
  std::string flaw;                           ///< "": all of it is known; else what is not: "points that …"

  int nodes() const noexcept { return static_cast<int>(share.size()); }
};

/// Looks for what makes the curve useless as a shape, and tells it in `flaw`.
void find_flaw(RecordedCurve& curve);

/// What of a result document another solve can start from.
struct RecordedState {
  std::vector<NamedNumbers> fields, multipliers;
  std::vector<RecordedCurve> curves;
  std::string sha256;  ///< of the document, "" of a state that was never written

  const RecordedCurve* find(const std::string& curve) const noexcept;
};

/// A state that is handed over to another scene: from a document, or in memory, with the same bits.
struct CarriedState {
  std::shared_ptr<const RecordedState> state;
  std::string name;      ///< what messages call it: "the start 'result.json'"
  std::string position;  ///< where errors about it stand: "file:line:column"
  std::string file;      ///< the document, absolute; "": it came from memory
  /// It becomes the rest state of the vessels. Empty: as [start] rest says.
  std::optional<bool> becomes_rest;
};

/// What is wrong with a document, to be told with its name before and its place: "… has no 'state'".
struct DocumentFlaw {
  std::string found, expected, mend;
};

/// Reads the state of a result document, `bowstring.result/1`, as JSON text. `name` is what messages call the document:
/// "the start 'result.json'". Everything that is wrong with it is in `flaws`; then the state is not to be used. A curve
/// that is not known is no flaw of the document: only what has to be interpolated needs it.
RecordedState read_recorded_state(const std::string& text, const std::string& name, std::vector<DocumentFlaw>& flaws);

}  // namespace bowstring
