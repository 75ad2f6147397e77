#pragma once

#include "core/interfaces/status.hpp"

namespace bowstring {

/// kind `writer`: a document → a file of another format.
class Writer {
 public:
  virtual ~Writer() = default;
  /// `document`: the whole text of a `bowstring.result/1` document, or of a `bowstring.transport/1` document: its
  /// `format` says which. `unsupported` where the writer does not take it. Writes to `file`, which the caller chose as
  /// a temporary name and renames on success.
  virtual Status write(const char* document, const char* file) noexcept = 0;
};

}  // namespace bowstring
