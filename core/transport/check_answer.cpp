#include "core/transport/check_answer.hpp"

#include <cmath>

namespace bowstring {
namespace {

std::string flaw_of(const SparseEntries& entries, const char* name, std::size_t rows, std::size_t columns) {
  const std::size_t count = entries.value.size();
  if (entries.row.size() != count || entries.column.size() != count) {
    return std::string(name) + " has lists of different lengths";
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto row = static_cast<std::size_t>(entries.row[k]), column = static_cast<std::size_t>(entries.column[k]);
    if (row >= rows || column >= columns) return std::string(name) + " has an entry outside of the matrix";
    if (!std::isfinite(entries.value[k])) return std::string(name) + " has an entry that is no finite number";
  }
  return "";
}

std::string flaw_of(const std::vector<double>& numbers, const char* name, std::size_t count) {
  if (numbers.empty() || numbers.size() == count) return "";
  return std::string(name) + " has " + std::to_string(numbers.size()) + " numbers instead of " + std::to_string(count);
}

}  // namespace

std::string flaw_of(const TransportAnswer& answer, std::size_t count_a, std::size_t count_b) {
  if (!std::isfinite(answer.value)) return "its value is no finite number";
  if (!std::isfinite(answer.transport_cost)) return "the cost of its plan is no finite number";
  const std::string flaws[] = {
      flaw_of(answer.plan, "its plan", count_a, count_b),
      flaw_of(answer.by_cost, "its derivative by costs", count_a, count_b),
      flaw_of(answer.by_cost_within_a, "its derivative by costs within the first measure", count_a, count_a),
      flaw_of(answer.by_cost_within_b, "its derivative by costs within the second measure", count_b, count_b),
      flaw_of(answer.dual_a, "its first dual", count_a),
      flaw_of(answer.dual_b, "its second dual", count_b),
      flaw_of(answer.weight_gradient_a, "its derivative by the first weights", count_a),
      flaw_of(answer.weight_gradient_b, "its derivative by the second weights", count_b),
      flaw_of(answer.position_gradient_a, "its derivative by the first positions", 3 * count_a),
      flaw_of(answer.position_gradient_b, "its derivative by the second positions", 3 * count_b),
  };
  for (const std::string& flaw : flaws) {
    if (!flaw.empty()) return flaw;
  }
  return "";
}

}  // namespace bowstring
