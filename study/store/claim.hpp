#pragma once

#include <string>

#include "core/interfaces/status.hpp"

namespace bowstring::study {

/// Who solves which run: every process that is about to write one holds its byte of a lock file (an open file
/// description lock, fcntl(2)). The system lets go of it when the process ends, in whatever way, so that no claim
/// outlives its holder; it also works on file systems that machines share, where these lock at all.
class Claims {
 public:
  Claims() = default;
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Opens the lock file, which it makes where there is none. Every process opens its own.
  Status open(const std::string& file);

  /// Whether the run is this process's from here on; false at once where somebody else has it.
  bool take(const std::string& hash);
  void leave(const std::string& hash);

  /// The whole folder, for what is written once for all runs; waits for it.
  void take_folder();
  void leave_folder();

 private:
  bool lock(long long byte, short kind, bool wait);

  int file_ = -1;
};

}  // namespace bowstring::study
