#pragma once

#include <type_traits>

namespace bowstring {

/// A small number that a loop knows while it is compiled; `any_size` leaves it to run time.
template <int n>
using Size = std::integral_constant<int, n>;
using any_size = Size<0>;

/// Calls use(Size<n>()) for n = 1 … most, use(any_size()) for every other n.
template <int most, class Use>
void with_size(int n, const Use& use) {
  if constexpr (most == 0) {
    (void)n;
    use(any_size());
  } else if (n == most) {
    use(Size<most>());
  } else {
    with_size<most - 1>(n, use);
  }
}

}  // namespace bowstring
