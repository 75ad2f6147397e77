#include "core/assembly/key_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace bowstring::testing {

namespace {

std::vector<int> stable_order(const std::vector<double>& key) {
  std::vector<int> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)]; });
  return order;
}

}  // namespace

TEST_CASE("an order by keys is that of a stable sort, however keys are spread, tied or infinite") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-0.1, 1.1);
  KeyOrder sorter;
  std::vector<int> order;
  for (const int count : {0, 1, 2, 17, 100, 1000, 40}) {
    std::vector<double> even, tied, bunched, ascending, same;
    for (int i = 0; i < count; ++i) {
      even.push_back(uniform(random));
      if (i % 7 == 3) even.back() = i % 2 == 0 ? infinity : -infinity;
      tied.push_back(static_cast<double>(random() % 5));
      bunched.push_back(i == 0 ? 1e6 : uniform(random));
      ascending.push_back(i);
      same.push_back(0.25);
    }
    for (const std::vector<double>& key : {even, tied, bunched, ascending, same}) {
      sorter.sort(key, order);
      CHECK(order == stable_order(key));
    }
    const std::vector<double> none(static_cast<std::size_t>(count), -infinity);
    sorter.sort(none, order);
    CHECK(order == stable_order(none));
  }
}

}  // namespace bowstring::testing
