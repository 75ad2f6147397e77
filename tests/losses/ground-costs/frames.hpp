#pragma once

#include <string>
#include <vector>

#include "core/lie/se3.hpp"
#include "core/transport/transport_comparison.hpp"

namespace ground_cost_test {

using namespace bowstring;
using lie::Se3;
using lie::se3::Twist;

/// A ground cost with settings, {"forward-weight", "0.1 1/mm"}.
class OpenCost {
 public:
  explicit OpenCost(const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings = {});

  const GroundCost& operator*() const noexcept { return transport_.ground_cost(); }
  const GroundCost* operator->() const noexcept { return &transport_.ground_cost(); }
  double operator()(const Se3& g, const Se3& h) const;
  /// The derivative by the body tangent of g.
  Vector<6> gradient(const Se3& g, const Se3& h) const;

 private:
  TransportComparison transport_;
};

Measure measure_of(const std::vector<Se3>& frames);

/// The same numbers with every library.
class Random {
 public:
  explicit Random(unsigned seed) : state_(seed) {}
  /// (0, 1)
  double uniform();
  /// About normal: mean 0, deviation 1.
  double normal();
  Twist twist();
  /// A frame turned by any rotation, within ±size.
  Se3 frame(double size);
  /// Bends, roll and forward motion of about `size`, lateral motion of its square.
  Twist dilated(double size);

 private:
  unsigned long long state_;
};

/// BOWSTRING_TEST_FULL: all; BOWSTRING_TEST_SHORT: few.
int repeats(int few, int usual, int all);

}  // namespace ground_cost_test
