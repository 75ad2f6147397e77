#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/composition/position.hpp"

namespace bowstring {

/// Collects what is wrong with the input, so that all of it can be said at once.
class Report {
 public:
  void error(const Position& position, std::string found, std::string expected, std::string mend);
  bool empty() const noexcept { return entries_.empty(); }
  /// By source, line and column; those of one place in the order in which they were found.
  std::vector<InputError> sorted() const;

 private:
  struct Entry {
    Position position;
    InputError error;
  };
  std::vector<Entry> entries_;
};

}  // namespace bowstring
