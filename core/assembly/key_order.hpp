#pragma once

#include <vector>

namespace bowstring {

/// Orders numbers by keys, those of equal keys by number, as std::stable_sort would: in time that grows with their
/// number where the keys are spread evenly. Infinite keys come first and last; none is NaN. Once it has ordered as
/// many, it allocates nothing.
class KeyOrder {
 public:
  /// `order` becomes the numbers 0 … keys − 1 in their order.
  void sort(const std::vector<double>& key, std::vector<int>& order);

 private:
  struct Item {
    double key;
    int number;
  };
  static void sort_bucket(Item* first, Item* end);

  std::vector<Item> items_;
  std::vector<int> bucket_, next_;  // per key, and per bucket
};

}  // namespace bowstring
