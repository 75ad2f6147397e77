#include "study/analysis/headlines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>

#include "core/composition/nearest.hpp"
#include "study/analysis/causes.hpp"
#include "study/analysis/convergence_headline.hpp"
#include "study/analysis/statistics.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr double no_change = 1e-6;  // of a quantity's size: what solves to their tolerance differ by
constexpr std::size_t most_headlines = 5;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::string with_unit(const std::string& number, const QuantityData& quantity) {
  return quantity.unit.empty() ? number : number + " " + quantity.unit;
}

std::string instead_of(const StudyData& data, const Effect& effect) {
  const AxisData& axis = data.axes[at(effect.axis)];
  return choice_text(axis, effect.to) + " instead of " +
         (effect.from < 0 ? "the baseline" : axis.label[at(effect.from)]);
}

/// "12 % (95 %: 10…14 %)", in the direction of the mean.
std::string amount_of(const StudyData& data, const Effect& effect) {
  const bool relative = std::isfinite(effect.relative);
  const double scale = (effect.mean < 0.0 ? -1.0 : 1.0) * (relative ? std::fabs(effect.relative / effect.mean) : 1.0);
  const double amount = scale * effect.mean, one = scale * effect.low, other = scale * effect.high;
  const double low = std::min(one, other), high = std::max(one, other);
  const std::string middle =
      relative ? percent(amount) : with_unit(figure(amount), data.quantities[at(effect.quantity)]);
  if (effect.pairs < 2) return middle;
  return middle + " (95 %: " + (relative ? percent_range(low, high) : range_text(figure(low), figure(high))) + ")";
}

bool changes(const Effect& effect) {
  return std::isfinite(effect.relative) ? std::fabs(effect.relative) > no_change : effect.mean != 0.0;
}

std::string effect_words(const StudyData& data, const Effect& effect, const std::string& object) {
  if (!changes(effect)) return instead_of(data, effect) + " leaves " + object + " as it is";
  return instead_of(data, effect) + (effect.mean < 0.0 ? " lowers " : " raises ") + object + " by " +
         amount_of(data, effect);
}

void add_effect(const StudyData& data, const Analysis& analysis, std::vector<Headline>& out) {
  std::vector<const Effect*> own;
  for (const Effect& effect : analysis.effects.quantities) {
    // What a parameter does is a sensitivity, where the grid gives one.
    const bool parameter = data.axes[at(effect.axis)].numeric() && !analysis.sensitivities.empty();
    if (effect.quantity == 0 && !parameter) own.push_back(&effect);
  }
  if (own.empty()) return;
  const Effect& first = *own[0];
  const QuantityData& quantity = data.quantities[0];
  std::string detail = "Over " + counted(first.pairs, "pair") + " of converged runs";
  if (data.along >= 0) detail += ", each on the finest mesh that both have";
  if (changes(first)) {
    detail += "; most, by " + with_unit(figure(first.largest), quantity) + ", at " +
              run_label(data, varying_axes(data), first.largest_run);
  }
  detail += ".";
  std::vector<std::string> rest;
  for (std::size_t k = 1; k < own.size(); ++k) rest.push_back(effect_words(data, *own[k], "it"));
  if (!rest.empty()) detail += " Then: " + listed(rest);
  const bool none = std::none_of(own.begin(), own.end(), [](const Effect* effect) { return changes(*effect); });
  out.push_back({HeadlineKind::effect,
                 none && own.size() > 1 ? "No alternative changes " + quantity.column
                                        : effect_words(data, first, quantity.column),
                 detail});
}

/// Those of the formulation that is recommended, one for each of its cases.
std::vector<int> recommended_lines(const Analysis& analysis) {
  const Recommendation& recommendation = analysis.recommendation;
  std::vector<int> out;
  if (recommendation.candidates.empty() || recommendation.axes.empty()) return out;
  const std::vector<int>& choice = recommendation.candidates.front().choice;
  for (std::size_t l = 0; l < analysis.lines.lines.size(); ++l) {
    bool same = true;
    for (std::size_t k = 0; k < recommendation.axes.size(); ++k) {
      const auto place = std::find(analysis.lines.axes.begin(), analysis.lines.axes.end(), recommendation.axes[k]);
      if (place == analysis.lines.axes.end()) continue;
      same = same &&
             analysis.lines.lines[l].choice[at(static_cast<int>(place - analysis.lines.axes.begin()))] == choice[k];
    }
    if (same) out.push_back(static_cast<int>(l));
  }
  return out;
}

std::string distribution_words(const StudyData& data, const Distribution& d) {
  const QuantityData& quantity = data.quantities[at(d.quantity)];
  std::string out = quantity.column + (d.label.empty() ? "" : " with " + d.label) + ": median " +
                    with_unit(figure(d.quantiles[2]), quantity) +
                    ", 5…95 %: " + with_unit(range_text(figure(d.quantiles[0]), figure(d.quantiles[4])), quantity);
  if (d.shares.empty() || d.r_squared < enough_explained) return out;
  const auto most = std::max_element(d.shares.begin(), d.shares.end());
  const AxisData& axis = data.axes[at(d.axes[at(static_cast<int>(most - d.shares.begin()))])];
  return out + "; " + axis.name + " makes up " + percent(*most) + " of its variance";
}

void add_distribution(const StudyData& data, const Analysis& analysis, std::vector<Headline>& out) {
  const std::vector<Distribution>& all = analysis.distributions;
  if (all.empty() || all[0].quantity != 0) return;
  std::vector<std::string> parts{
      "Over " + counted(all[0].count, "run") +
      (all[0].left_out > 0 ? ", " + std::to_string(all[0].left_out) + " without a value" : "")};
  if (!all[0].note.empty()) parts.push_back(all[0].note);
  for (std::size_t k = 1; k < all.size(); ++k) parts.push_back(distribution_words(data, all[k]));
  out.push_back({HeadlineKind::effect, distribution_words(data, all[0]), listed(parts)});
}

/// What 1 % more of a parameter does at the places where it is known.
struct Influence {
  std::string parameter;
  std::vector<double> elasticity;  // rising

  double size() const {
    std::vector<double> sizes;
    for (const double one : elasticity) sizes.push_back(std::fabs(one));
    std::sort(sizes.begin(), sizes.end());
    return quantile(sizes, 0.5);
  }
  /// "raises", where it does so everywhere.
  std::string verb() const {
    return elasticity.front() > 0.0 ? "raises" : elasticity.back() < 0.0 ? "lowers" : "changes";
  }
  /// "T -0.2…-0.1 % at 4 places"
  std::string range() const {
    const std::string words = parameter + " " + percent_range(0.01 * elasticity.front(), 0.01 * elasticity.back());
    return elasticity.size() == 1 ? words : words + " at " + std::to_string(elasticity.size()) + " places";
  }
};

/// On the first quantity, the largest first.
std::vector<Influence> find_influences(const StudyData& data, const Analysis& analysis) {
  std::map<int, std::vector<double>> elasticities;  // axis → at its places
  for (const Sensitivity& place : analysis.sensitivities) {
    for (const SensitivityEntry& entry : place.entries) {
      if (place.quantity == 0 && std::isfinite(entry.elasticity)) elasticities[entry.axis].push_back(entry.elasticity);
    }
  }
  std::vector<Influence> out;
  for (auto& [axis, values] : elasticities) {
    std::sort(values.begin(), values.end());
    out.push_back({data.axes[at(axis)].name, values});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Influence& one, const Influence& other) { return one.size() > other.size(); });
  return out;
}

/// Of numbers that have no effects: which of them the first quantity follows most.
void add_sensitivity(const StudyData& data, const Analysis& analysis, std::vector<Headline>& out) {
  const std::vector<Influence> influences = find_influences(data, analysis);
  if (influences.empty()) return;
  const Influence& first = influences[0];
  std::string text = "1 % more of " + first.parameter + " " + first.verb() + " " + data.quantities[0].column + " by " +
                     percent(0.01 * first.size());
  if (influences.size() > 1) {
    const Influence& second = influences[1];
    text += ", of " + second.parameter + (second.verb() == first.verb() ? "" : " " + second.verb() + " it") + " by " +
            percent(0.01 * second.size());
  }
  std::vector<std::string> ranges;
  bool one_place = true;
  for (const Influence& influence : influences) {
    ranges.push_back(influence.range());
    one_place = one_place && influence.elasticity.size() == 1;
  }
  out.push_back({HeadlineKind::effect, text,
                 (one_place ? "What 1 % more of each does: " : "Medians of the size over the places of the grid; ") +
                     listed(ranges)});
}

void add_inseparable(const Analysis& analysis, std::vector<Headline>& out) {
  if (analysis.inseparable.empty()) return;
  std::vector<std::string> parts;
  for (const Inseparable& pair : analysis.inseparable) parts.push_back(pair.text);
  out.push_back(
      {HeadlineKind::warning, parts[0],
       "Their effects on all quantities stand in one proportion wherever it was computed: a change of one can be "
       "made good by the other. " +
           (parts.size() > 1 ? listed(parts) : "")});
}

/// "8 stalled, 4 invalid", the most frequent first.
std::vector<std::pair<std::string, int>> by_frequency(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> out(counts.begin(), counts.end());
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

/// "an edge of # mm": reasons that differ in numbers alone are one.
std::string without_numbers(const std::string& reason) {
  static const std::regex number(R"(\d+(\.\d+)?(e[-+]?\d+)?)");
  return std::regex_replace(reason, number, "#");
}

/// Counts reasons; those that are alike count as one, in the words of the first.
class Reasons {
 public:
  void add(const std::string& reason) {
    if (reason.empty()) return;
    Group& group = groups_[without_numbers(reason)];
    if (group.count == 0) group.first = reason;
    group.several = group.several || group.first != reason;
    ++group.count;
  }

  /// "4: edge 3 has folded; 2 like: …", the most frequent first.
  std::string text() const {
    std::vector<Group> groups;
    for (const auto& [key, group] : groups_) groups.push_back(group);
    std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.count > b.count; });
    std::vector<std::string> parts;
    for (const Group& group : groups)
      parts.push_back(std::to_string(group.count) + (group.several ? " like: " : ": ") + group.first);
    return listed(parts);
  }

 private:
  struct Group {
    std::string first;
    int count = 0;
    bool several = false;
  };
  std::map<std::string, Group> groups_;
};

void add_invalid(const StudyData& data, std::vector<Headline>& out) {
  Reasons reasons;
  int count = 0;
  for (const RunData& run : data.runs) {
    if (run.status != "invalid") continue;
    ++count;
    reasons.add(run.reason);
  }
  if (count == 0) return;
  const int all = static_cast<int>(data.runs.size());
  std::string text =
      of_all(count, all) + " runs came out invalid: they satisfy every row and are no equilibrium of the curves";
  out.push_back({HeadlineKind::warning, text, "They count nowhere. " + reasons.text()});
}

void add_failures(const StudyData& data, std::vector<Headline>& out) {
  std::map<std::string, int> statuses;
  Reasons reasons;
  std::vector<Case> cases;
  int failures = 0;
  for (const RunData& run : data.runs) {
    cases.push_back({run.choice, !run.converged()});
    if (run.converged()) continue;
    ++failures;
    ++statuses[run.status];
    reasons.add(run.reason);
  }
  if (failures == 0) return;
  const int all = static_cast<int>(data.runs.size());
  std::vector<std::string> kinds;
  for (const auto& [status, times] : by_frequency(statuses)) kinds.push_back(std::to_string(times) + " " + status);
  std::vector<int> axes;
  for (int a : varying_axes(data)) {
    if (!sampled(data.axes[at(a)])) axes.push_back(a);
  }
  const Cause cause = find_cause(cases, axes);
  const std::string whole =
      of_all(failures, all) + (all == 1 ? " run" : " runs") + " did not converge: " + comma_separated(kinds);
  std::string text = whole;
  if (cause.found()) {
    text = of_all(cause.hits_with, failures) + (failures == 1 ? " failure has " : " failures have ") +
           conditions_text(data, cause.conditions) + "; of " + counted(cause.with, "run") + " with it " +
           std::to_string(cause.hits_with) + (cause.hits_with == 1 ? " fails" : " fail") + ", of " +
           std::to_string(cause.without) + " without " + std::to_string(cause.hits_without);
  }
  out.push_back({HeadlineKind::failures, text, (cause.found() ? whole + ". " : "") + reasons.text()});
}

void keep_five(std::vector<Headline>& headlines) {
  while (headlines.size() > most_headlines) {
    const auto effect = std::find_if(headlines.rbegin(), headlines.rend(),
                                     [](const Headline& h) { return h.kind == HeadlineKind::effect; });
    headlines.erase(effect == headlines.rend() ? headlines.end() - 1 : std::next(effect).base());
  }
}

}  // namespace

std::vector<Headline> write_headlines(const StudyData& data, const Analysis& analysis) {
  std::vector<Headline> out;
  const Recommendation& best = analysis.recommendation;
  if (!best.text.empty()) {
    out.push_back({HeadlineKind::recommendation, best.text, best.detail, recommended_lines(analysis)});
  }
  if (const auto convergence = convergence_headline(data, analysis.lines)) out.push_back(*convergence);
  add_effect(data, analysis, out);
  add_distribution(data, analysis, out);
  const bool has_effect =
      std::any_of(out.begin(), out.end(), [](const Headline& h) { return h.kind == HeadlineKind::effect; });
  if (!has_effect) add_sensitivity(data, analysis, out);
  add_inseparable(analysis, out);
  add_invalid(data, out);
  add_failures(data, out);
  keep_five(out);
  return out;
}

}  // namespace bowstring::study
