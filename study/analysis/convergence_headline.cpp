#include "study/analysis/convergence_headline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/analysis/causes.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Lines by how a quantity behaves along them.
struct Tally {
  std::vector<const Line*> settling, moving, unjudged, beside;
  int judged() const { return static_cast<int>(settling.size() + moving.size()); }
};

Tally tally(const Lines& all, std::size_t quantity) {
  Tally out;
  for (const Line& line : all.lines) {
    const std::optional<Fit>& fit = line.fits[quantity];
    if (!fit) continue;
    if (fit->verdict == Settling::too_few) {
      out.unjudged.push_back(&line);
    } else {
      (fit->settles() ? out.settling : out.moving).push_back(&line);
      if (std::isfinite(fit->beside)) out.beside.push_back(&line);
    }
  }
  return out;
}

std::string order_range(const std::vector<const Line*>& lines) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Line* line : lines) {
    const double order = line->fits[0]->order;
    if (!std::isfinite(order)) continue;
    low = std::min(low, order);
    high = std::max(high, order);
  }
  return low > high ? "" : "order " + range_text(order_text(low), order_text(high));
}

std::string in_brackets(const std::string& text) { return text.empty() ? "" : " (" + text + ")"; }

std::string beside_words(const Tally& lines) {
  const std::size_t count = lines.beside.size();
  if (count == 0) return "";
  return count == lines.settling.size() ? ", beside the reference"
                                        : ", " + std::to_string(count) + " of them beside the reference";
}

/// How far, and with what.
std::string beside_detail(const StudyData& data, const Lines& all, const Tally& lines) {
  if (lines.beside.empty()) return "";
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  std::vector<Case> cases;
  for (const Line* line : lines.settling) {
    const double beside = line->fits[0]->beside;
    cases.push_back({data.runs[at(line->runs[0])].choice, std::isfinite(beside)});
    if (!std::isfinite(beside)) continue;
    least = std::min(least, beside);
    most = std::max(most, beside);
  }
  const Cause cause = find_cause(cases, all.axes);
  const std::string those =
      cause.found() ? ": " + of_all(cause.hits_with, cause.with) + " with " + conditions_text(data, cause.conditions)
                    : "";
  return " Beside the reference, by " + percent_range(least, most) + ", settle " +
         of_all(static_cast<int>(lines.beside.size()), static_cast<int>(lines.settling.size())) + those + ".";
}

std::string split_words(const StudyData& data, const Tally& lines, const Cause& cause) {
  const int settle_with = cause.with - cause.hits_with, settle_without = cause.without - cause.hits_without;
  std::string out = "What keeps " + data.quantities[0].column + " from converging is " +
                    conditions_text(data, cause.conditions) + ": " + of_all(settle_with, cause.with) +
                    (cause.with == 1 ? " line with it settles, " : " lines with it settle, ") +
                    of_all(settle_without, cause.without) + " without" + in_brackets(order_range(lines.settling));
  add_clause(out, beside_words(lines), headline_length);
  return out;
}

Cause cause_of_moving(const StudyData& data, const Lines& all, const Tally& lines) {
  std::vector<Case> cases;
  for (const Line* line : lines.settling) cases.push_back({data.runs[at(line->runs[0])].choice, false});
  for (const Line* line : lines.moving) cases.push_back({data.runs[at(line->runs[0])].choice, true});
  return find_cause(cases, all.axes);
}

std::string convergence_words(const StudyData& data, const Lines& all, const Tally& lines) {
  const std::string name = data.quantities[0].column;
  const int settling = static_cast<int>(lines.settling.size()), judged = lines.judged();
  if (judged == 0) {
    return name + ": too few runs converged to tell whether it settles as the mesh is refined";
  }
  const std::string& first = (settling > 0 ? lines.settling : lines.moving)[0]->fits[0]->text;
  if (judged == 1) return name + (settling > 0 ? " converges: " : " does not settle: it ") + first;
  if (settling == judged) {
    return name + " converges in all " + std::to_string(judged) + " lines" + in_brackets(order_range(lines.settling)) +
           beside_words(lines);
  }
  if (settling == 0) return name + " settles in none of " + std::to_string(judged) + " lines; the first one " + first;
  const Cause cause = cause_of_moving(data, all, lines);
  if (cause.found()) return split_words(data, lines, cause);
  return name + " settles in " + of_all(settling, judged) + " lines" + in_brackets(order_range(lines.settling)) +
         "; no axis tells which";
}

/// "per-node, nodes and 2 more: moves by 31 % with every doubling", lines with the same behaviour together.
void add_behaviours(const std::vector<const Line*>& lines, std::vector<std::string>& parts) {
  std::vector<std::pair<const Line*, int>> kinds;
  for (const Line* line : lines) {
    const auto known = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const auto& kind) { return kind.first->fits[0]->text == line->fits[0]->text; });
    if (known == kinds.end()) {
      kinds.emplace_back(line, 0);
    } else {
      ++known->second;
    }
  }
  for (const auto& [first, more] : kinds) {
    const std::string others = more > 0 ? " and " + std::to_string(more) + " more" : "";
    parts.push_back(first->label + others + ": " + first->fits[0]->text);
  }
}

std::string convergence_detail(const StudyData& data, const Lines& all, const Tally& lines) {
  std::vector<std::string> parts;
  for (const std::vector<const Line*>* group : {&lines.moving, &lines.settling, &lines.unjudged}) {
    add_behaviours(*group, parts);
  }
  std::string out = listed(parts) + beside_detail(data, all, lines);
  std::vector<std::string> others;
  for (std::size_t q = 1; q < data.quantities.size(); ++q) {
    const Tally own = tally(all, q);
    if (own.judged() == 0) continue;
    others.push_back(data.quantities[q].column + " settles in " +
                     of_all(static_cast<int>(own.settling.size()), own.judged()) + " lines");
  }
  if (!others.empty()) out += " Other quantities: " + listed(others);
  return out;
}

}  // namespace

std::optional<Headline> convergence_headline(const StudyData& data, const Lines& all) {
  if (data.quantities.empty()) return std::nullopt;
  const Tally lines = tally(all, 0);
  if (lines.judged() == 0 && lines.unjudged.empty()) return std::nullopt;
  return Headline{HeadlineKind::convergence, convergence_words(data, all, lines), convergence_detail(data, all, lines)};
}

}  // namespace bowstring::study
