#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace bowstring {

/// A view of `size` contiguous numbers owned by somebody else. C++17 stand-in for std::span, so that plugins
/// built with an older standard see the same layout.
template <class T>
class Span {
 public:
  constexpr Span() noexcept = default;
  constexpr Span(T* data, std::size_t size) noexcept : data_(data), size_(size) {}

  template <class U, class = std::enable_if_t<std::is_same_v<std::remove_const_t<T>, U>>>
  Span(std::vector<U>& numbers) noexcept : data_(numbers.data()), size_(numbers.size()) {}

  template <class U, class = std::enable_if_t<std::is_same_v<T, const U>>>
  Span(const std::vector<U>& numbers) noexcept : data_(numbers.data()), size_(numbers.size()) {}

  template <class U, class = std::enable_if_t<std::is_same_v<T, const U>>>
  constexpr Span(Span<U> other) noexcept : data_(other.data()), size_(other.size()) {}

  constexpr T* data() const noexcept { return data_; }
  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr T& operator[](std::size_t i) const noexcept { return data_[i]; }
  constexpr T* begin() const noexcept { return data_; }
  constexpr T* end() const noexcept { return data_ + size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace bowstring
