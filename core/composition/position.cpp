#include "core/composition/position.hpp"

#include <tuple>

namespace bowstring {

std::string Position::text() const {
  if (source == nullptr) return "";
  if (line == 0) return source->name;
  return source->name + ":" + std::to_string(line) + ":" + std::to_string(column);
}

bool Position::before(const Position& other) const noexcept {
  const int order = source ? source->order : -1;
  const int other_order = other.source ? other.source->order : -1;
  return std::tie(order, line, column) < std::tie(other_order, other.line, other.column);
}

}  // namespace bowstring
