#pragma once

#include <string>
#include <utility>

namespace bowstring {

/// What a call across the plugin boundary answers. No exception crosses it.
enum class Code : int {
  ok = 0,
  refused,        ///< the trial point moves a curve further than its last accepted point allows: shorten the step
  left_window,    ///< a closest point has left the segments that its row covers: shorten the step or start an epoch
  unsupported,    ///< the component cannot do this, for the reason in the text
  invalid_input,  ///< the user's input is wrong; the text says where, what was expected and how to mend it
  failed,         ///< the computation broke down (NaN, an exception, a library error)
  interrupted     ///< the user or a limit stopped it
};

struct Status {
  Code code = Code::ok;
  std::string text;

  bool ok() const noexcept { return code == Code::ok; }
  explicit operator bool() const noexcept { return ok(); }

  static Status failure(Code code, std::string text) { return Status{code, std::move(text)}; }
};

}  // namespace bowstring
