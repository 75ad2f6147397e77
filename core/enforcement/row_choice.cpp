#include "core/enforcement/row_choice.hpp"

#include <algorithm>

#include "core/composition/nearest.hpp"

namespace bowstring {

namespace {

bool is_named(const std::vector<std::string>& names, const RowGroup& group) {
  return !group.closure && std::find(names.begin(), names.end(), group.name) != names.end();
}

/// Of a name that none of the scene's constraints has.
Status refused(const ProblemSummary& problem, const std::string& name) {
  std::vector<std::string> known;
  for (const RowGroup& group : problem.row_groups) {
    if (!group.closure) known.push_back(group.name);
  }
  const std::string expected = known.empty()
                                   ? "; expected nothing, as the scene has no constraint; remove 'on'"
                                   : "; expected " + quoted_alternatives(known) + ", the scene's constraints; ";
  for (const RowGroup& group : problem.row_groups) {
    if (!group.closure || group.name != name) continue;
    return Status::failure(Code::invalid_input, "'on' names the rows '" + name + "', " + group.text +
                                                    ", which hold a curve together and stay exact" + expected +
                                                    (known.empty() ? "" : "remove it"));
  }
  const std::string near = did_you_mean(nearest_names(name, known));
  return Status::failure(Code::invalid_input, "'on' names '" + name + "', which is no constraint" + expected +
                                                  (known.empty()  ? ""
                                                   : near.empty() ? "name one of them"
                                                                  : near));
}

}  // namespace

Status without_rows(const ProblemSummary& problem, const std::vector<std::string>& names, ProblemSummary& out) {
  for (const std::string& name : names) {
    const bool known = std::any_of(problem.row_groups.begin(), problem.row_groups.end(),
                                   [&](const RowGroup& group) { return !group.closure && group.name == name; });
    if (!known) return refused(problem, name);
  }
  out = problem;
  out.row_groups.clear();
  if (names.empty()) out.inequalities = 0;
  int first = 0;
  for (RowGroup group : problem.row_groups) {
    if (is_named(names, group)) {
      out.inequalities -= group.inequalities;
      out.equalities -= group.count - group.inequalities;
      continue;
    }
    if (names.empty()) {
      group.count -= group.inequalities;
      group.inequalities = 0;
    }
    group.first = first;
    first += group.count;
    if (group.count > 0) out.row_groups.push_back(std::move(group));
  }
  return {};
}

std::vector<char> chosen_rows(const Problem& problem, const std::vector<std::string>& names) {
  std::vector<char> chosen(static_cast<std::size_t>(problem.rows()), 0);
  if (names.empty()) {
    for (std::size_t r = 0; r < chosen.size(); ++r) chosen[r] = problem.row_lower()[r] < problem.row_upper()[r] ? 1 : 0;
  }
  for (const RowGroup& group : problem.summary().row_groups) {
    if (is_named(names, group)) std::fill_n(chosen.begin() + group.first, group.count, 1);
  }
  return chosen;
}

}  // namespace bowstring
