#pragma once

#include <chrono>
#include <limits>
#include <string>

#include "core/interfaces/solver.hpp"

namespace bowstring::newton {

struct Limits {
  double tolerance = 1e-8;  ///< stationarity in N, rows in mm, complementarity in N mm
  int max_iterations = 500;
  double time_limit = std::numeric_limits<double>::infinity();  ///< s
};

/// How a method ended.
struct Ending {
  Claim claim = Claim::failed;
  std::string reason;
};

/// History, limits and the user's wish to stop, over all phases of a solve.
class Progress {
 public:
  Progress(const Limits& limits, const SolverContext& context, SolverResult& result)
      : limits_(limits), context_(context), result_(result), begin_(std::chrono::steady_clock::now()) {}

  /// Records an iterate; false: a limit is reached or the user stops, and `reason` says which.
  bool record(double energy, double stationarity, double penetration, double step);
  const std::string& reason() const noexcept { return reason_; }
  const Limits& limits() const noexcept { return limits_; }
  SolverResult& result() noexcept { return result_; }

 private:
  Limits limits_;
  const SolverContext& context_;
  SolverResult& result_;
  std::chrono::steady_clock::time_point begin_;
  std::string reason_;
};

}  // namespace bowstring::newton
