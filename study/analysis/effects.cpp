#include "study/analysis/effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/analysis/lines.hpp"
#include "study/analysis/statistics.hpp"

namespace bowstring::study {

namespace {

constexpr std::size_t most_numbers = 6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Pair {
  int from, to;  // runs
};

/// Alternative → run, for all runs that agree in the other axes.
using Group = std::map<int, int>;

std::vector<Group> groups_of(const StudyData& data, int axis) {
  std::map<std::vector<int>, Group> groups;
  for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) {
    std::vector<int> others = data.runs[at(run)].choice;
    others[at(axis)] = 0;
    groups[others].emplace(data.runs[at(run)].choice[at(axis)], run);
  }
  std::vector<Group> out;
  for (const auto& [others, group] : groups) out.push_back(group);
  return out;
}

std::vector<Pair> pairs_of(const std::vector<Group>& groups, int from, int to) {
  std::vector<Pair> out;
  for (const Group& group : groups) {
    const auto one = group.find(from), other = group.find(to);
    if (one != group.end() && other != group.end()) out.push_back({one->second, other->second});
  }
  return out;
}

/// Differences of the given numbers over those pairs that have both.
void summarise(Effect& effect, const std::vector<Pair>& pairs, const std::vector<double>& value) {
  std::vector<double> differences, sizes;
  for (const Pair& pair : pairs) {
    const double difference = value[at(pair.to)] - value[at(pair.from)];
    if (!std::isfinite(difference)) continue;
    if (differences.empty() || std::fabs(difference) > std::fabs(effect.largest)) {
      effect.largest = difference;
      effect.largest_run = pair.to;
    }
    differences.push_back(difference);
    sizes.push_back(std::fabs(value[at(pair.from)]));
  }
  const MeanInterval interval = mean_interval(differences);
  effect.pairs = static_cast<int>(differences.size());
  effect.mean = interval.mean;
  effect.low = interval.low;
  effect.high = interval.high;
  const double size = mean(sizes);
  effect.relative = size > 0.0 ? interval.mean / size : std::nan("");
}

void turn_into_ratios(Effect& effect) {
  for (double* value : {&effect.mean, &effect.low, &effect.high, &effect.largest}) *value = std::exp(*value);
  effect.relative = effect.mean - 1.0;
}

bool larger(const Effect& one, const Effect& other) {
  const auto size = [](const Effect& effect) {
    return std::isnan(effect.relative) ? -1.0 : std::fabs(effect.relative);
  };
  return size(one) > size(other);
}

}  // namespace

Effects find_effects(const StudyData& data) {
  std::vector<std::vector<double>> values(data.quantities.size());
  std::vector<double> log_seconds;
  for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) {
    for (std::size_t q = 0; q < values.size(); ++q) values[q].push_back(counted_value(data, static_cast<int>(q), run));
    const RunData& record = data.runs[at(run)];
    const bool timed = record.converged() && record.solve_seconds > 0.0;
    log_seconds.push_back(timed ? std::log(record.solve_seconds) : std::nan(""));
  }
  Effects out;
  for (int a = 0; a < static_cast<int>(data.axes.size()); ++a) {
    const AxisData& axis = data.axes[at(a)];
    if (a == data.along || sampled(axis) || !varies(data, a)) continue;
    if (axis.numeric() && axis.label.size() > most_numbers) continue;
    const std::vector<Group> groups = groups_of(data, a);
    for (int to = 0; to < static_cast<int>(axis.label.size()); ++to) {
      Effect effect;
      effect.axis = a;
      effect.to = to;
      effect.from = -1;
      std::vector<Pair> pairs = pairs_of(groups, -1, to);
      if (pairs.empty()) {
        effect.from = 0;
        if (to > 0) pairs = pairs_of(groups, 0, to);
      }
      for (std::size_t q = 0; q < values.size(); ++q) {
        Effect own = effect;
        own.quantity = static_cast<int>(q);
        summarise(own, pairs, values[q]);
        if (own.pairs > 0) out.quantities.push_back(own);
      }
      effect.quantity = Effect::solve_time;
      summarise(effect, pairs, log_seconds);
      if (effect.pairs == 0) continue;
      turn_into_ratios(effect);
      out.times.push_back(effect);
    }
  }
  std::stable_sort(out.quantities.begin(), out.quantities.end(), larger);
  std::stable_sort(out.times.begin(), out.times.end(), larger);
  return out;
}

}  // namespace bowstring::study
