#include "core/assembly/key_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int per_bucket = 4;  // on average
constexpr int few = 16;        // that are sorted by insertion

}  // namespace

void KeyOrder::sort(const std::vector<double>& key, std::vector<int>& order) {
  const auto count = key.size();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double k : key) {
    if (!std::isfinite(k)) continue;
    low = std::min(low, k);
    high = std::max(high, k);
  }
  const int inner = static_cast<int>(count) / per_bucket + 1;
  const double scale = high > low ? inner / (high - low) : 0.0;
  next_.assign(at(inner) + 3, 0);
  bucket_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    int bucket = key[i] < low ? 0 : inner + 1;
    if (key[i] >= low && key[i] <= high) bucket = 1 + std::min(inner - 1, static_cast<int>((key[i] - low) * scale));
    bucket_[i] = bucket;
    ++next_[at(bucket) + 1];
  }
  for (std::size_t b = 1; b < next_.size(); ++b) next_[b] += next_[b - 1];
  items_.resize(count);
  for (std::size_t i = 0; i < count; ++i) items_[at(next_[at(bucket_[i])]++)] = {key[i], static_cast<int>(i)};
  // Each bucket's `next_` is now its end; those without a finite key are in order already.
  for (int b = 1; b <= inner; ++b) sort_bucket(items_.data() + next_[at(b) - 1], items_.data() + next_[at(b)]);
  order.resize(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = items_[i].number;
}

void KeyOrder::sort_bucket(Item* first, Item* end) {
  if (end - first > few) {
    const auto before = [](const Item& a, const Item& b) {
      return a.key < b.key || (a.key == b.key && a.number < b.number);
    };
    if (!std::is_sorted(first, end, before)) std::sort(first, end, before);
    return;
  }
  for (Item* item = first + (first < end); item < end; ++item) {
    const Item moving = *item;
    Item* to = item;
    for (; to > first && to[-1].key > moving.key; --to) *to = to[-1];
    *to = moving;
  }
}

}  // namespace bowstring
