#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring {

/// What the Hessian of the Lagrangian says of a stationary point, on the null space of the equality rows and of the
/// active inequality rows and bounds.
enum class Curvature : char { unjudged, minimum, saddle, degenerate };
/// "minimum", "saddle", "degenerate"; null where nothing was judged.
const char* curvature_name(Curvature curvature) noexcept;

struct SecondOrder {
  Curvature curvature = Curvature::unjudged;
  std::string reason;           ///< one sentence: what was found, or why nothing could be judged
  int negative_directions = 0;  ///< negative eigenvalues with every active row held
  /// N/mm²: δᵀHδ / ∫|δp|² ds of the most negative direction: what a foundation would have to add along the curves.
  std::optional<double> leftmost_curvature;
  std::string leftmost_mode;               ///< in words
  std::vector<std::string> neutral_modes;  ///< directions without curvature, in words
  std::vector<int> deciding_rows;          ///< weakly active or undecided rows without which it is no minimum
  int factorizations = 0;
};

/// Judges a point that meets the first-order conditions, at the assembly's accepted state. `stationarity`: N, of the
/// certificate: forces so small are not told from zero. The verdict rests on inertias of shifted matrices, README.md.
void judge_second_order(Assembly& assembly, Span<const double> q, Span<const double> multipliers, double stationarity,
                        SecondOrder& out);

}  // namespace bowstring
