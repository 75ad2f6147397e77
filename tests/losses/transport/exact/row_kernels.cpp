#include "losses/transport/network-simplex/row_kernels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems.hpp"

using namespace bowstring::simplex;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Row {
  std::vector<double> cost, add;
};

/// Few values, so that there are ties; some of them infinite.
Row random_row(std::mt19937& random, int count) {
  Row out;
  for (int j = 0; j < count; ++j) {
    out.cost.push_back(exact_test::below(random, 8) == 0 ? infinity : exact_test::below(random, 12) - 3.0);
    out.add.push_back(exact_test::below(random, 8) == 0 ? infinity : 0.25 * exact_test::below(random, 5));
  }
  return out;
}

}  // namespace

TEST_CASE("rows of every length: what a plain loop finds") {
  std::mt19937 random(17);
  for (int repeat = 0; repeat < 20; ++repeat) {
    for (int count = 1; count < 140; ++count) {
      CAPTURE(count);
      const auto [cost, add] = random_row(random, count);
      double least = infinity, slack = infinity, largest = 0.0, finite = 0.0;
      int first = -1;
      long within = 0;
      for (int j = 0; j < count; ++j) {
        const auto k = static_cast<std::size_t>(j);
        const double sum = cost[k] + add[k], reduced = sum - 1.5;
        if (sum < least) first = j;
        least = std::min(least, sum);
        if (reduced > 0.25) slack = std::min(slack, reduced);
        within += reduced <= 0.25 ? 1 : 0;
        if (std::fabs(cost[k]) < 6.0) largest = std::max(largest, std::fabs(cost[k]));
        if (cost[k] < infinity) finite = std::max(finite, std::fabs(cost[k]));
      }
      const Minimum minimum = row_minimum(cost.data(), add.data(), count);
      CHECK(minimum.value == least);
      if (first >= 0) CHECK(place_of(minimum, cost.data(), add.data()) == first);
      const RowLook look = look_at_row(cost.data(), add.data(), 1.5, 0.25, count);
      CHECK(look.least == least - 1.5);
      CHECK(look.slack == slack);
      CHECK(look.within == within);
      CHECK(largest_below(cost.data(), cost.size(), 6.0) == largest);
      CHECK(largest_below(cost.data(), cost.size(), infinity) == finite);
    }
  }
}
