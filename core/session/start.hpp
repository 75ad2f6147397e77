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
  std::vector<std::string> warnings;  ///< what of a recorded state was not taken
  StartOrigin origin;
  bool only = false;  ///< no second attempt from the scene's own start where the solve from this one fails
};

/// The coordinates of a recorded state for this scene. What the scene holds stays where the scene's own start has it:
/// ends may have been moved since. All that does not fit is told in `flaws`, and then there are none.
std::vector<double> recorded_coordinates(const Scene& scene, const RecordedState& state, const std::string& name,
                                         std::vector<DocumentFlaw>& flaws, std::vector<std::string>& warnings);

/// Puts what the scene holds where its own start has it.
void hold_ends(const Scene& scene, std::vector<double>& q);

/// The multipliers of a recorded state for these rows. Those of a group of another count are zero, with a warning.
std::vector<double> recorded_multipliers(const std::vector<RowOrigin>& rows, const RecordedState& state,
                                         const std::string& name, std::vector<std::string>& warnings);

/// The state of q and the multipliers, one per row, as a result document holds it. `Manifold` names as there.
RecordedState record_state(const Scene& scene, const std::vector<RowOrigin>& rows, const std::vector<double>& q,
                           const std::vector<double>& multipliers);

/// "R", "R^n", "S1", "S2", "SO3": a manifold in result documents.
const char* manifold_name(Manifold manifold) noexcept;

}  // namespace bowstring
