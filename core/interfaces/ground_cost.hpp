#pragma once

#include <cstddef>
#include <vector>

#include "core/interfaces/measure.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// kind `ground-cost`: the SQUARED distance between a place of one measure and a place of another. It is symmetric,
/// c(g, h) = c(h, g), and does not change from call to call. Members may be called from several threads at once.
class GroundCost {
 public:
  virtual ~GroundCost() = default;

  /// Unit of the cost: "mm^2"; "" where its weights make it a number.
  virtual const char* unit() const noexcept = 0;
  /// Places have to be frames, and not points alone.
  virtual bool needs_frames() const noexcept = 0;
  /// One evaluation takes so long that a transport method does better to look at `lower_bound` first and to evaluate
  /// only the pairs that matter.
  virtual bool dear() const noexcept { return false; }

  /// `pairs`: (i, j), i of `a` and j of `b`. `value`: one per pair. `gradient`: per pair the derivative with respect to
  /// the body tangent (ω, ν) of the FIRST place, 6 numbers, unit of the cost per rad and per mm; left alone when empty.
  /// The body axes of a place without orientation are the global ones. Where the cost is not differentiable, one of the
  /// limits of gradients nearby.
  virtual Status evaluate(const Measure& a, const Measure& b, Span<const int> pairs, Span<double> value,
                          Span<double> gradient) const noexcept = 0;

  /// The costs of the places [begin, end) of `a` to all of `b`, row major: (end − begin) × b.count(). The same numbers
  /// as `evaluate`; to be overridden where that is faster.
  virtual Status rows(const Measure& a, const Measure& b, int begin, int end, Span<double> value) const noexcept {
    try {
      const std::vector<int> pairs = all_pairs(begin, end, static_cast<int>(b.count()));
      return evaluate(a, b, pairs, value, {});
    } catch (...) {
      return Status::failure(Code::failed, "out of memory");
    }
  }

  /// Certified lower bounds of what `rows` gives, cheap ones; of a cost that is `dear`.
  virtual Status lower_bounds(const Measure& a, const Measure& b, int begin, int end,
                              Span<double> value) const noexcept {
    (void)a, (void)b, (void)begin, (void)end, (void)value;
    return Status::failure(Code::unsupported, "this ground cost has no lower bounds");
  }

 protected:
  static std::vector<int> all_pairs(int begin, int end, int columns) {
    std::vector<int> pairs;
    pairs.reserve(2 * static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(columns));
    for (int i = begin; i < end; ++i) {
      for (int j = 0; j < columns; ++j) pairs.insert(pairs.end(), {i, j});
    }
    return pairs;
  }
};

}  // namespace bowstring
