#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/measure/curve_measure.hpp"

namespace bowstring {

struct InputError;

/// How a user names a measure:
///   points.csv         every row is a place (core/measure/measure_table.hpp);
///   points.csv#curve   the rows are the nodes of a curve, in order;
///   result.json#NAME   a curve of a result document.
struct MeasureName {
  std::string file;
  std::string curve;  ///< what follows the last '#'; "" without one

  std::string text() const { return curve.empty() ? file : file + "#" + curve; }
};

/// A '#' in the name of a file is taken for that only where the file exists.
MeasureName measure_name(const std::string& text);

/// A measure as its file gives it, before it is known how a curve of it is sampled.
struct GivenMeasure {
  MeasureName name;
  std::string sha256;  ///< of the file
  bool is_curve = false;
  Measure places;            ///< of a file of places; of a curve in a file of places what the file has of its nodes
  bool has_weights = false;  ///< the file has them
  NodalCurve curve;          ///< of a curve
};

/// Reads the text of the named file. Everything that is wrong with it goes into `errors`, with file, line and the index
/// of the place; then the answer is empty.
std::optional<GivenMeasure> read_given_measure(const MeasureName& name, const std::string& text,
                                               std::vector<InputError>& errors);

/// The measure itself, and of a curve where its places are. `sampling` is for curves; weights and orientations that a
/// file gives the nodes of a curve are taken as they stand where `keeps_weights`, and refused where places are
/// resampled. What is wrong goes into `errors`; then the answer is empty.
std::optional<CurveMeasure> measure_of(const GivenMeasure& given, const CurveSampling& sampling, bool keeps_weights,
                                       std::vector<InputError>& errors);

}  // namespace bowstring
