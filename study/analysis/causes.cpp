#include "study/analysis/causes.hpp"

#include <algorithm>
#include <numeric>

#include "core/composition/nearest.hpp"
#include "study/analysis/lines.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr double least_index = 0.5;     // that one axis must tell
constexpr double gain_of_second = 0.1;  // that a second one must add

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Σ over the cases of a cell of 1/hits for a hit, −1/others for another: a set's sum is its index.
using Table = std::vector<std::vector<double>>;

struct Candidate {
  double index = 0.0;
  std::vector<Condition> conditions;
};

class Search {
 public:
  Search(const std::vector<Case>& cases, const std::vector<int>& axes) : cases_(cases), axes_(axes) {
    for (const Case& one : cases) hits_ += one.hit;
  }

  Cause find() {
    const int count = static_cast<int>(cases_.size());
    if (hits_ == 0 || hits_ == count) return {};
    Candidate best;
    for (int axis : axes_) keep(best, single(axis), 1e-9);
    Candidate pair = best;
    for (std::size_t a = 0; a < axes_.size() && best.index < 1.0 - 1e-9; ++a) {
      for (std::size_t b = a + 1; b < axes_.size(); ++b) search_pair(axes_[a], axes_[b], pair);
    }
    if (pair.index > best.index + gain_of_second) best = pair;
    return best.index < least_index ? Cause{} : counted_cause(best);
  }

 private:
  static void keep(Candidate& best, const Candidate& other, double gain) {
    if (other.index > best.index + gain) best = other;
  }

  int alternatives(int axis) const {
    int most = -1;
    for (const Case& one : cases_) most = std::max(most, one.choice[at(axis)]);
    return most + 2;  // −1 among them
  }

  double weight(const Case& one) const {
    return one.hit ? 1.0 / hits_ : -1.0 / (static_cast<double>(cases_.size()) - hits_);
  }

  static Condition condition(int axis, const std::vector<char>& chosen) {
    Condition out{axis, {}};
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      if (chosen[k]) out.alternatives.push_back(static_cast<int>(k) - 1);
    }
    return out;
  }

  Candidate single(int axis) const {
    std::vector<double> sum(at(alternatives(axis)), 0.0);
    for (const Case& one : cases_) sum[at(one.choice[at(axis)] + 1)] += weight(one);
    std::vector<char> chosen(sum.size(), 0);
    double index = 0.0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      if (sum[k] > 1e-12) chosen[k] = 1, index += sum[k];
    }
    return {index, {condition(axis, chosen)}};
  }

  void search_pair(int a, int b, Candidate& best) const {
    Table table(at(alternatives(a)), std::vector<double>(at(alternatives(b)), 0.0));
    for (const Case& one : cases_) table[at(one.choice[at(a)] + 1)][at(one.choice[at(b)] + 1)] += weight(one);
    for (std::size_t j = 0; j < table[0].size(); ++j) keep(best, rectangle(table, a, b, j), 1e-9);
  }

  /// From one column on, the best rows for the columns and the best columns for the rows until neither changes.
  static Candidate rectangle(const Table& table, int a, int b, std::size_t column) {
    std::vector<char> rows(table.size(), 0), columns(table[0].size(), 0);
    columns[column] = 1;
    double index = 0.0;
    for (double before = -1.0; index > before + 1e-12;) {
      before = index;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < columns.size(); ++j) sum += columns[j] ? table[i][j] : 0.0;
        rows[i] = sum > 1e-12;
      }
      index = 0.0;
      for (std::size_t j = 0; j < columns.size(); ++j) {
        double sum = 0.0;
        for (std::size_t i = 0; i < rows.size(); ++i) sum += rows[i] ? table[i][j] : 0.0;
        columns[j] = sum > 1e-12;
        if (columns[j]) index += sum;
      }
    }
    return {index, {condition(a, rows), condition(b, columns)}};
  }

  static bool holds(const std::vector<Condition>& conditions, const Case& one) {
    return std::all_of(conditions.begin(), conditions.end(), [&](const Condition& c) {
      return std::binary_search(c.alternatives.begin(), c.alternatives.end(), one.choice[at(c.axis)]);
    });
  }

  Cause counted_cause(const Candidate& found) const {
    Cause out;
    out.conditions = found.conditions;
    for (const Case& one : cases_) {
      const bool with = holds(out.conditions, one);
      (with ? out.with : out.without) += 1;
      (with ? out.hits_with : out.hits_without) += one.hit;
    }
    return out;
  }

  const std::vector<Case>& cases_;
  const std::vector<int>& axes_;
  int hits_ = 0;
};

/// Whether they are all numbers from one on, or up to one.
std::string one_sided(const AxisData& axis, const std::vector<int>& alternatives) {
  if (!axis.numeric() || alternatives.size() < 2 || alternatives.front() < 0) return "";
  std::vector<int> order(axis.number.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return axis.number[at(a)] < axis.number[at(b)]; });
  std::vector<char> chosen;
  for (int k : order) chosen.push_back(std::binary_search(alternatives.begin(), alternatives.end(), k));
  const std::size_t count = alternatives.size(), most = order.size() - count;
  if (std::count(chosen.end() - static_cast<std::ptrdiff_t>(count), chosen.end(), 1) == static_cast<long>(count)) {
    return axis.name + " ≥ " + axis.label[at(order[most])];
  }
  if (std::count(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count), 1) == static_cast<long>(count)) {
    return axis.name + " ≤ " + axis.label[at(order[count - 1])];
  }
  return "";
}

}  // namespace

Cause find_cause(const std::vector<Case>& cases, const std::vector<int>& axes) { return Search(cases, axes).find(); }

std::string condition_text(const AxisData& axis, const Condition& condition) {
  const std::vector<int>& alternatives = condition.alternatives;
  if (alternatives == std::vector<int>{-1}) return choice_text(axis, -1);
  const std::string range = one_sided(axis, alternatives);
  if (!range.empty()) return range;
  std::vector<std::string> names;
  for (int k : alternatives) names.push_back(k < 0 ? "its base" : axis.label[at(k)]);
  return axis.name + " = " + alternatives_text(names);
}

std::string conditions_text(const StudyData& data, const std::vector<Condition>& conditions) {
  std::vector<std::string> parts;
  for (const Condition& c : conditions) parts.push_back(condition_text(data.axes[at(c.axis)], c));
  return joined(parts, " and ");
}

}  // namespace bowstring::study
