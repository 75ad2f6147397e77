#pragma once

#include <vector>

namespace bowstring {

/// What the weight of a place of a curve is in proportion to.
enum class CurveWeights : int {
  uniform,       ///< 1
  arc_length,    ///< the length of curve that the place stands for
  lumen_section  ///< that length times the radius squared: the volume of the lumen
};

/// "uniform", "arc-length", "lumen-section".
const char* curve_weights_name(CurveWeights weights) noexcept;
/// The three names, separated by '|'.
inline constexpr const char* curve_weights_choices = "uniform|arc-length|lumen-section";
/// False where the name is none of them.
bool read_curve_weights(const char* name, CurveWeights& out) noexcept;

/// Where a measure counts for more: a factor 1 + Σ weight · exp(−((s − at)/spread)²/2) along the curve.
struct MeasureStation {
  double at = 0.0;      ///< arc length from the first end, mm
  double spread = 1.0;  ///< mm, > 0
  double weight = 1.0;  ///< not negative
};

/// How a curve becomes a measure.
struct CurveSampling {
  int points = 0;  ///< how many places; 0: the curve's nodes
  CurveWeights weights = CurveWeights::uniform;
  std::vector<MeasureStation> stations;
};

}  // namespace bowstring
