#pragma once

#include <array>
#include <limits>
#include <vector>

namespace bowstring::checking {

/// The derivative of k numbers along one direction, as claimed, and what the numbers are worth.
struct Claim {
  std::vector<double> value;   ///< k
  std::vector<double> size;    ///< k: (Σ (∂f/∂x_u d_u)²)^½, what the value is relative to
  std::vector<double> weight;  ///< k: turns numbers of different units into comparable ones
  std::vector<int> family;     ///< k: numbers of one family are judged by the largest size among them, times …
  double floor = 1.0;          ///< … this
  double least = 0.0;          ///< of what a value is relative to
  double magnitude = 0.0;      ///< numbers that f is computed from may be so large: what rounding is relative to
};

/// f at −2h, −h, 0, h, 2h times the direction.
using Samples = std::array<const std::vector<double>*, 5>;

/// How one component came out.
enum class Outcome : int { agrees, wrong, not_smooth };

/// Compares a claim with central differences at ever smaller steps, each a tenth of the one before. A component agrees
/// where one step's difference does, or where the misses shrink with the step, as beside a kink of the second
/// derivative. What never does is a wrong derivative where the differences settle, and a place that is not smooth where
/// they do not, or where one-sided differences stay apart there or in another component along the same direction.
class Comparison {
 public:
  Comparison(Claim claim, double tolerance);
  void add(double step, const Samples& f);
  bool compared() const noexcept { return compared_; }
  /// Smaller steps have nothing to tell.
  bool settled() const noexcept;
  /// Every claimed number and every difference vanishes.
  bool vanishes() const noexcept { return vanishes_; }
  int components() const noexcept { return static_cast<int>(claim_.value.size()); }
  Outcome outcome(int component) const noexcept;
  /// Relative to size, what rounding explains subtracted; of the best step. The tolerance where only misses shrink.
  double error(int component) const noexcept;

 private:
  struct Track {
    double error = std::numeric_limits<double>::infinity();
    int steps = 0;                        // that rounding did not blur
    double noise = 0.0;                   // that rounding leaves of the newest difference
    double miss[3] = {};                  // of the last steps, the newest first
    double difference[2] = {};            // likewise
    double jump = 0.0, first_jump = 0.0;  // between the one-sided differences
  };
  bool converges(const Track& track) const noexcept;
  bool keeps_jumping(const Track& track) const noexcept;

  Claim claim_;
  double tolerance_;
  bool compared_ = false, vanishes_ = true;
  std::vector<double> scale_;
  std::vector<Track> track_;
};

}  // namespace bowstring::checking
