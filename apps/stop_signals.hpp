#pragma once

#include <atomic>
#include <initializer_list>
#include <vector>

namespace bowstring::apps {

/// While it lives, these signals do not end the process: they are noted.
class StopSignals {
 public:
  explicit StopSignals(std::initializer_list<int> signals);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether one has come, in the life of the process.
  static const std::atomic<bool>& seen() noexcept;

 private:
  std::vector<int> signals_;
};

}  // namespace bowstring::apps
