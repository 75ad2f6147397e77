#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"

namespace bowstring {

/// A place in which two compositions differ. Values are written as an override takes them, `--set path=value`: numbers
/// with their unit, text without quotes, lists and tables as TOML.
struct CompositionDifference {
  std::string path;                 ///< as an override takes it: "wire.lunderquist.radius"
  std::optional<std::string> a, b;  ///< empty: that composition has nothing there
  /// The path of a `type` that differs: only one of the two declares this key, or each has its own default of it,
  /// so that it is no difference of its own. "": it is one.
  std::string because_of;
  bool matters = true;  ///< a result can depend on it; not on a title
};

/// All places in which two resolved compositions (JSON texts, core/composition/resolved.hpp) differ, in the order of
/// the first. Entries of lists are told apart by their `name`; a term without a name of its own is the same term when
/// its type has changed. What differs in a step and not in the state before it has a path of that step:
/// `step.tighter."energy.axial-tension.tension"`.
///
/// `registry`: knows the units in which plugins declare their numbers, and is asked for the plugins of what differs
/// alone; null, or of plugins that cannot be loaded: numbers stand without unit.
std::vector<CompositionDifference> composition_differences(const std::string& a, const std::string& b,
                                                           Registry* registry);

}  // namespace bowstring
