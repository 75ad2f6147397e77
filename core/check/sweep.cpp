#include "core/check/sweep.hpp"

#include <algorithm>

#include "core/check/states.hpp"
#include "core/check/unknowns.hpp"

namespace bowstring::checking {

namespace {

constexpr int small_scene = 300;  // unknowns: so many are differenced one by one
constexpr int directions_per_field = 3;
constexpr double ladder[] = {10.0 * middle_step, middle_step, 0.1 * middle_step};

void record(Finding& finding, const Comparison& comparison, std::size_t state, std::size_t direction) {
  if (!comparison.compared()) {
    ++finding.unreached;
    return;
  }
  ++finding.compared;
  finding.vanishes = finding.vanishes && comparison.vanishes();
  for (int c = 0; c < comparison.components(); ++c) {
    const Finding::Place place{state, direction, c};
    const Outcome outcome = comparison.outcome(c);
    if (outcome == Outcome::not_smooth) {
      if (finding.kinks++ == 0) finding.kink = place;
      continue;
    }
    if (outcome == Outcome::wrong && finding.wrong++ == 0) finding.error = 0.0;
    const bool counts = outcome == Outcome::wrong || finding.wrong == 0;
    if (!counts || comparison.error(c) < finding.error) continue;
    finding.error = comparison.error(c);
    finding.place = place;
  }
}

Probe probe_along(Assembly& assembly, const std::vector<double>& q, const Sweep& sweep, const Direction& direction,
                  double t) {
  std::vector<double> delta = direction.delta;
  for (double& number : delta) number *= t;
  return probe(assembly, q, delta, sweep.multipliers);
}

}  // namespace

std::vector<Direction> make_directions(const Assembly& assembly, unsigned seed) {
  const int n = assembly.unknowns();
  const std::vector<double> size = natural_steps(assembly);
  std::vector<Direction> out;
  if (n <= small_scene) {
    for (int u = 0; u < n; ++u) {
      out.push_back({unknown_name(assembly, u), std::vector<double>(at(n), 0.0), u, u + 1});
      out.back().delta[at(u)] = size[at(u)];
    }
    return out;
  }
  const auto add = [&](const std::string& name, int begin, int end) {
    Direction direction{name, std::vector<double>(at(n), 0.0), begin, end};
    const std::vector<double> numbers = random_numbers(n, seed++);
    for (int u = begin; u < end; ++u) direction.delta[at(u)] = numbers[at(u)] * size[at(u)];
    out.push_back(std::move(direction));
  };
  for (const FieldGroup& group : field_groups(assembly)) {
    if (group.begin == group.end) continue;
    for (int k = 0; k < directions_per_field; ++k) add(group_name(assembly, group), group.begin, group.end);
  }
  add("all unknowns", 0, n);
  return out;
}

void Finding::add(const Finding& other) {
  if (failure.empty()) failure = other.failure;
  const bool outranks = (other.wrong > 0) != (wrong > 0) ? other.wrong > 0 : other.error > error;
  if (outranks) {
    error = other.error;
    place = other.place;
  }
  if (kinks == 0) kink = other.kink;
  compared += other.compared;
  wrong += other.wrong;
  kinks += other.kinks;
  unreached += other.unreached;
  vanishes = vanishes && other.vanishes;
}

std::vector<Finding> compare(Assembly& assembly, const std::vector<double>& q, std::size_t state, const Sweep& sweep,
                             const std::vector<char>& wanted) {
  std::vector<Finding> out(sweep.quantities.size());
  const Claims claims(assembly, q, sweep.multipliers);
  std::vector<std::size_t> good;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Status& status = claims.status(sweep.quantities[k]);
    if (wanted[k] == 0) continue;
    if (status.ok()) good.push_back(k);
    if (!status.ok()) out[k].failure = status.text.empty() ? "it could not be evaluated" : status.text;
  }
  const Probe here = probe(assembly, q, std::vector<double>(at(assembly.unknowns()), 0.0), sweep.multipliers);
  for (std::size_t d = 0; d < sweep.directions.size(); ++d) {
    const Direction& direction = sweep.directions[d];
    std::vector<Comparison> comparisons;
    for (const std::size_t k : good) {
      const double tolerance = sweep.quantities[k].second_order() ? sweep.second_tolerance : sweep.first_tolerance;
      comparisons.emplace_back(claims.along(sweep.quantities[k], direction.delta), tolerance);
    }
    for (const double step : ladder) {
      const auto settled = [](const Comparison& c) { return c.settled(); };
      if (std::all_of(comparisons.begin(), comparisons.end(), settled)) break;
      std::vector<Probe> probes;
      for (const double t : {-2.0, -1.0, 1.0, 2.0}) {
        probes.push_back(probe_along(assembly, q, sweep, direction, t * step));
      }
      for (std::size_t i = 0; i < good.size(); ++i) {
        if (comparisons[i].settled()) continue;
        const Quantity& quantity = sweep.quantities[good[i]];
        const Samples samples{sample(quantity, probes[0]), sample(quantity, probes[1]), sample(quantity, here),
                              sample(quantity, probes[2]), sample(quantity, probes[3])};
        if (std::find(samples.begin(), samples.end(), nullptr) == samples.end()) comparisons[i].add(step, samples);
      }
    }
    for (std::size_t i = 0; i < good.size(); ++i) record(out[good[i]], comparisons[i], state, d);
  }
  return out;
}

}  // namespace bowstring::checking
