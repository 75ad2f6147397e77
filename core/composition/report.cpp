#include "core/composition/report.hpp"

#include <algorithm>
#include <utility>

namespace bowstring {

std::string InputError::text() const {
  std::string result = position.empty() ? found : position + ": " + found;
  if (!expected.empty()) result += "; expected " + expected;
  if (!mend.empty()) result += "; " + mend;
  return result;
}

void Report::error(const Position& position, std::string found, std::string expected, std::string mend) {
  entries_.push_back({position, {position.text(), std::move(found), std::move(expected), std::move(mend)}});
}

std::vector<InputError> Report::sorted() const {
  std::vector<const Entry*> order;
  for (const Entry& entry : entries_) order.push_back(&entry);
  std::stable_sort(order.begin(), order.end(),
                   [](const Entry* a, const Entry* b) { return a->position.before(b->position); });
  std::vector<InputError> errors;
  for (const Entry* entry : order) errors.push_back(entry->error);
  return errors;
}

}  // namespace bowstring
