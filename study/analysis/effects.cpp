#include "study/analysis/effects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "study/analysis/lines.hpp"
#include "study/analysis/statistics.hpp"

namespace bowstring::study {

namespace {

constexpr std::size_t most_numbers = 6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Runs that agree in all axes but one and the mesh: alternative → resolution, fine to coarse → run.
using Group = std::map<int, std::map<double, int, std::greater<>>>;

class Pairs {
 public:
  Pairs(const StudyData& data, int axis) {
    const std::vector<double> resolution = data.along < 0 ? std::vector<double>{} : resolutions(data);
    std::map<std::vector<int>, Group> groups;
    for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) {
      std::vector<int> others = data.runs[at(run)].choice;
      const int alternative = others[at(axis)], mesh = data.along < 0 ? -1 : others[at(data.along)];
      others[at(axis)] = 0;
      if (data.along >= 0) others[at(data.along)] = 0;
      groups[others][alternative].emplace(mesh < 0 ? -1.0 : resolution[at(mesh)], run);
    }
    for (auto& [others, group] : groups) groups_.push_back(std::move(group));
  }

  bool any(int from, int to) const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [&](const Group& group) { return group.count(from) > 0 && group.count(to) > 0; });
  }

  /// Differences of the given numbers over those pairs that have both.
  void summarise(Effect& effect, const std::vector<double>& value) const {
    std::vector<double> differences, sizes;
    for (const Group& group : groups_) {
      const auto one = group.find(effect.from), other = group.find(effect.to);
      if (one == group.end() || other == group.end()) continue;
      for (const auto& [mesh, run] : other->second) {
        const auto partner = one->second.find(mesh);
        if (partner == one->second.end()) continue;
        const double difference = value[at(run)] - value[at(partner->second)];
        if (!std::isfinite(difference)) continue;
        if (differences.empty() || std::fabs(difference) > std::fabs(effect.largest)) {
          effect.largest = difference;
          effect.largest_run = run;
        }
        differences.push_back(difference);
        sizes.push_back(std::fabs(value[at(partner->second)]));
        break;
      }
    }
    const MeanInterval interval = mean_interval(differences);
    effect.pairs = static_cast<int>(differences.size());
    effect.mean = interval.mean;
    effect.low = interval.low;
    effect.high = interval.high;
    const double size = mean(sizes);
    effect.relative = size > 0.0 ? interval.mean / size : std::nan("");
  }

 private:
  std::vector<Group> groups_;
};

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
    const Pairs pairs(data, a);
    for (int to = 0; to < static_cast<int>(axis.label.size()); ++to) {
      Effect effect;
      effect.axis = a;
      effect.from = pairs.any(-1, to) ? -1 : 0;
      effect.to = to;
      if (effect.from == to || !axis.same_problem(effect.from, to)) continue;
      for (std::size_t q = 0; q < values.size(); ++q) {
        Effect own = effect;
        own.quantity = static_cast<int>(q);
        pairs.summarise(own, values[q]);
        if (own.pairs > 0) out.quantities.push_back(own);
      }
      effect.quantity = Effect::solve_time;
      pairs.summarise(effect, log_seconds);
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
