#pragma once

#include <vector>

namespace bowstring::newton {

/// The filter of a line search (A. Wächter and L. T. Biegler, SIAM J. Optim. 16 (2005) 1; Math. Program. 106 (2006)
/// 25): pairs (violation, objective), and a trial is acceptable that none of them dominates.
class Filter {
 public:
  /// Forgets everything; a trial's violation may not exceed `largest`.
  void reset(double largest);
  bool accepts(double violation, double objective) const noexcept;
  /// Whether a trial improves enough on a point in violation or in objective.
  static bool improves(double violation, double objective, double old_violation, double old_objective) noexcept;
  void add(double violation, double objective);

 private:
  struct Entry {
    double violation, objective;
  };
  double largest_ = 0.0;
  std::vector<Entry> entries_;
};

}  // namespace bowstring::newton
