#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"

namespace bowstring {

/// Why nothing was solved; the numbers are the exit codes of the command.
enum class RefusalKind : int {
  none = 0,
  wrong_input = 2,   ///< the user's to mend: composition, data, paths, a plugin name that nobody offers
  plugin_failed = 3  ///< a plugin that is known could not be loaded or used
};

/// What went wrong before anything could be solved. Errors as values: nothing is thrown to the caller.
struct Refusal {
  std::vector<InputError> errors;  ///< the input is wrong
  Status plugin_failure;           ///< a known plugin could not be loaded or used

  bool any() const noexcept { return !errors.empty() || !plugin_failure.ok(); }
  RefusalKind kind() const noexcept {
    if (!errors.empty()) return RefusalKind::wrong_input;
    return plugin_failure.ok() ? RefusalKind::none : RefusalKind::plugin_failed;
  }
  /// Every error on a line of its own, without a newline at the end: "file:line:column: found; expected …; mend".
  std::string text() const;
};

}  // namespace bowstring
