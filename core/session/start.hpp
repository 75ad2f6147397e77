#pragma once

#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"
#include "core/composition/recorded_state.hpp"

namespace bowstring {

/// Which document a start was read from.
struct StartOrigin {
  std::string file;    ///< absolute; "": none, the state came from memory
  std::string sha256;  ///< of the document; "": not known
};

/// Where a solver begins.
struct Start {
  std::vector<double> q;              ///< coordinates; empty: the scene's own start
  std::vector<double> multipliers;    ///< one per row, or empty
  std::vector<std::string> warnings;  ///< what of a recorded state was not taken as it stands
  StartOrigin origin;
  bool only = false;  ///< no second attempt from the scene's own start where the solve from this one fails
  /// CurveView::previous of each curve, empty where it has none. No curves: what the session shows stays.
  std::vector<std::vector<double>> previous;
};

/// The coordinates of a carried state for this scene, `shapes` being what it is to the scene's curves. A curve of the
/// same mesh takes field by field what fits entry for entry, bit for bit; what does not fit, its kinematics adopts from
/// the curve's shape, which a warning says. Vessels whose rest state it has become are at that rest state. What the
/// scene holds stays where the scene's own start has it: ends may have been moved since. All that cannot be taken is
/// told in `flaws`, and then there are no coordinates.
std::vector<double> carried_coordinates(const Scene& scene, const CarriedState& carried, const CarriedCurves& shapes,
                                        std::vector<DocumentFlaw>& flaws, std::vector<std::string>& warnings);

/// Puts what the scene holds where its own start has it.
void hold_ends(const Scene& scene, std::vector<double>& q);

/// The multipliers of a carried state for these rows. Those of rows on a curve of another mesh are interpolated by the
/// material that they stand at, rows being taken as evenly spread over nodes; those of a group of another count on the
/// same mesh, or of another kinematics, are zero, with a warning.
std::vector<double> carried_multipliers(const Scene& scene, const std::vector<RowOrigin>& rows,
                                        const CarriedState& carried, const CarriedCurves& shapes,
                                        std::vector<std::string>& warnings);

/// A start at a carried state in a session that was built without it. Where it does not fit, its flaws, and no
/// coordinates.
Start start_from(const Scene& scene, const std::vector<RowOrigin>& rows, const CarriedState& carried,
                 std::vector<DocumentFlaw>& flaws);

/// The state of q and the multipliers, one per row, as a result document holds it. `Manifold` names as there.
RecordedState record_state(const Scene& scene, const std::vector<RowOrigin>& rows, const std::vector<double>& q,
                           const std::vector<double>& multipliers);

/// "R", "R^n", "S1", "S2", "SO3": a manifold in result documents.
const char* manifold_name(Manifold manifold) noexcept;

}  // namespace bowstring
