#pragma once

#include <cstdlib>
#include <functional>
#include <new>

/// Counts what a process allocates. To be included by one source of a program: it replaces operator new, through which
/// every library of the process, plugins included, allocates.
namespace bowstring::testing {

inline long allocations = 0;

inline long allocations_of(const std::function<void()>& call) {
  const long before = allocations;
  call();
  return allocations - before;
}

}  // namespace bowstring::testing

void* operator new(std::size_t size) {
  ++bowstring::testing::allocations;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
