#include "solvers/newton/progress.hpp"

namespace bowstring::newton {

bool Progress::record(double energy, double stationarity, double penetration, double step) {
  const int iteration = result_.history.empty() ? 0 : result_.history.back().iteration + 1;
  result_.history.push_back({iteration, energy, stationarity, penetration, step});
  result_.iterations = iteration;
  if (context_.on_iteration && !context_.on_iteration(result_.history.back())) reason_ = "stopped by the user";
  if (reason_.empty() && iteration >= limits_.max_iterations) reason_ = "the iteration limit was reached";
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (reason_.empty() && seconds > limits_.time_limit) reason_ = "the time limit was reached";
  return reason_.empty();
}

}  // namespace bowstring::newton
