#include "study/plan/plan.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "core/composition/nearest.hpp"
#include "core/result/provenance.hpp"
#include "study/plan/identity.hpp"

namespace bowstring::study {
namespace {

constexpr std::size_t most_runs = 10000000;
constexpr double most_checked_runs = 2000.0;  // of a study that is wrong anyway

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Product {
 public:
  explicit Product(const StudyFile& study) : study_(study) {}

  std::vector<std::vector<int>> choices() const {
    std::vector<int> start(study_.groups.size(), 0);
    std::vector<std::vector<int>> out;
    if (study_.combination == Combination::one_at_a_time) {
      add(start, out);
      for (std::size_t g = 0; g < study_.groups.size(); ++g) {
        for (int k = 1; k < study_.groups[g].count; ++k) {
          std::vector<int> other = start;
          other[g] = k;
          add(other, out);
        }
      }
      return out;
    }
    for (std::vector<int> index = start; out.size() <= most_runs;) {
      add(index, out);
      std::size_t g = index.size();
      while (g > 0 && ++index[g - 1] == study_.groups[g - 1].count) index[--g] = 0;
      if (g == 0) break;
    }
    return out;
  }

 private:
  void add(const std::vector<int>& index, std::vector<std::vector<int>>& out) const {
    std::vector<int> choice(study_.axes.size(), 0);
    for (std::size_t g = 0; g < index.size(); ++g) {
      for (const int axis : study_.groups[g].axes) choice[at(axis)] = index[g];
    }
    const auto excluded = [&](const Exclusion& exclusion) {
      return std::all_of(exclusion.choices.begin(), exclusion.choices.end(), [&](const auto& one) {
        return std::find(one.second.begin(), one.second.end(), choice[at(one.first)]) != one.second.end();
      });
    };
    if (std::none_of(study_.exclusions.begin(), study_.exclusions.end(), excluded)) out.push_back(std::move(choice));
  }

  const StudyFile& study_;
};

/// Finds what of the runs' errors is an error of the study.
class Judge {
 public:
  Judge(const Plan& plan, const std::vector<Refusal>& readings) : plan_(plan), readings_(readings) {}

  void judge(Refusal& refusal) const {
    const bool all_failed = std::all_of(readings_.begin(), readings_.end(), [](const Refusal& r) { return r.any(); });
    std::set<std::string> told;
    for (std::size_t r = 0; r < readings_.size(); ++r) {
      for (const InputError& error : readings_[r].errors) {
        if (told.count(error.text()) > 0 || !(all_failed || is_of_the_study(error))) continue;
        told.insert(error.text());
        refusal.errors.push_back(error);
      }
    }
    for (std::size_t r = 0; r < readings_.size() && refusal.plugin_failure.ok(); ++r) {
      if (!readings_[r].plugin_failure.ok() && (all_failed || some_alternative_never_loads(plan_.runs[r].choice))) {
        refusal.plugin_failure = readings_[r].plugin_failure;
      }
    }
  }

 private:
  bool has_error_at(std::size_t run, const std::string& position) const {
    const std::vector<InputError>& errors = readings_[run].errors;
    return std::any_of(errors.begin(), errors.end(), [&](const InputError& e) { return e.position == position; });
  }

  bool is_of_the_study(const InputError& error) const {
    for (std::size_t a = 0; a < plan_.study.axes.size(); ++a) {
      const Axis& axis = plan_.study.axes[a];
      for (std::size_t k = 0; k < axis.overrides.size(); ++k) {
        for (const Override& one : axis.overrides[k]) {
          if (one.position == error.position) return every_run_with(a, static_cast<int>(k), error.position);
        }
      }
    }
    for (std::size_t r = 0; r < readings_.size(); ++r) {
      if (!has_error_at(r, error.position)) return false;
    }
    return true;
  }

  bool every_run_with(std::size_t axis, int alternative, const std::string& position) const {
    for (std::size_t r = 0; r < readings_.size(); ++r) {
      if (plan_.runs[r].choice[axis] == alternative && !has_error_at(r, position)) return false;
    }
    return true;
  }

  bool some_alternative_never_loads(const std::vector<int>& choice) const {
    for (std::size_t a = 0; a < choice.size(); ++a) {
      bool never = true;
      for (std::size_t r = 0; r < readings_.size(); ++r) {
        if (plan_.runs[r].choice[a] == choice[a]) never = never && !readings_[r].plugin_failure.ok();
      }
      if (never) return true;
    }
    return false;
  }

  const Plan& plan_;
  const std::vector<Refusal>& readings_;
};

void note_libraries(const Provenance& provenance, std::map<std::string, std::string>& libraries) {
  libraries["kernel"] = provenance.kernel_sha256;
  for (const PluginProvenance& plugin : provenance.plugins) {
    libraries[std::string(kind_name(plugin.kind)) + "/" + plugin.name] = plugin.origin.sha256;
  }
}

/// Chains along the warm axis: the runs that agree in every axis but those walked with it.
std::vector<std::vector<int>> chains_of(const Plan& plan) {
  std::vector<std::vector<int>> chains;
  const StudyFile& study = plan.study;
  std::vector<char> warm(study.axes.size(), 0);
  for (const AxisGroup& group : study.groups) {
    if (std::find(group.axes.begin(), group.axes.end(), study.warm_along) == group.axes.end()) continue;
    for (const int axis : group.axes) warm[at(axis)] = 1;
  }
  std::map<std::vector<int>, std::size_t> place;
  for (std::size_t r = 0; r < plan.runs.size(); ++r) {
    std::vector<int> key = plan.runs[r].choice;
    for (std::size_t a = 0; a < key.size(); ++a) {
      if (warm[a] != 0) key[a] = -1;
    }
    if (study.warm_along < 0) key.push_back(static_cast<int>(r));
    const auto [found, fresh] = place.emplace(std::move(key), chains.size());
    if (fresh) chains.emplace_back();
    chains[found->second].push_back(static_cast<int>(r));
  }
  return chains;
}

void check_reference(const Plan& plan, Refusal& refusal) {
  const Reference& reference = plan.study.reference;
  if (reference.axis < 0) return;
  const auto held = [&](const PlannedRun& run) {
    return run.refusal.empty() && std::all_of(reference.at.begin(), reference.at.end(), [&](const auto& place) {
             return run.choice[at(place.first)] == place.second;
           });
  };
  if (std::any_of(plan.runs.begin(), plan.runs.end(), held)) return;
  refusal.errors.push_back(
      {reference.position, "the reference (" + reference.text + ") is not reached: no run is there",
       "at least one run of the study that can be solved", "take the exclusion back, or hold other axes under 'at'"});
}

}  // namespace

CompositionRequest request_of(const StudyFile& study, const std::vector<int>& choice) {
  CompositionRequest request;
  request.file = study.base;
  request.overrides = study.set;
  for (std::size_t a = 0; a < choice.size(); ++a) {
    if (choice[a] < 0) continue;
    const Axis& axis = study.axes[a];
    if (const std::string& base = axis.base[at(choice[a])]; !base.empty()) request.file = base;
    const std::vector<Override>& overrides = axis.overrides[at(choice[a])];
    request.overrides.insert(request.overrides.end(), overrides.begin(), overrides.end());
  }
  return request;
}

std::string refusal_reason(const Refusal& refusal) {
  std::vector<std::string> texts;
  for (InputError error : refusal.errors) {
    error.position.clear();
    texts.push_back(error.text());
  }
  if (!refusal.plugin_failure.ok()) texts.push_back(refusal.plugin_failure.text);
  std::string out = joined(texts, "; ");
  std::replace(out.begin(), out.end(), '\n', ' ');
  return out;
}

std::string run_label(const StudyFile& study, const std::vector<int>& choice) {
  std::vector<std::string> texts;
  for (std::size_t a = 0; a < choice.size(); ++a) {
    const AxisData& axis = study.axes[a].data;
    if (choice[a] >= 0) texts.push_back(axis.name + " = " + axis.label[at(choice[a])]);
  }
  return comma_separated(texts);
}

std::optional<Plan> make_plan(StudyFile study, Registry& registry, Refusal& refusal) {
  Plan plan;
  plan.study = std::move(study);
  for (std::vector<int>& choice : Product(plan.study).choices()) {
    PlannedRun run;
    run.choice = std::move(choice);
    plan.runs.push_back(std::move(run));
  }
  if (plan.runs.empty() || plan.runs.size() > most_runs) {
    refusal.errors.push_back({plan.study.file, plan.runs.empty() ? "the exclusions leave no run" : "too many runs",
                              "between 1 and " + std::to_string(most_runs) + " runs",
                              plan.runs.empty() ? "take one back" : "shorten its axes"});
    return std::nullopt;
  }
  std::vector<Refusal> readings(plan.runs.size());
  Identity identity;
  for (const std::vector<int>& chain : chains_of(plan)) {
    Unit unit;
    for (const int r : chain) {
      PlannedRun& run = plan.runs[at(r)];
      CompositionOutcome outcome = load_composition(request_of(plan.study, run.choice), registry);
      readings[at(r)] = {std::move(outcome.errors), outcome.plugin_failure};
      if (!outcome.composition) {
        run.refusal = refusal_reason(readings[at(r)]);
        continue;
      }
      const Provenance provenance = provenance_of(*outcome.composition, registry);
      note_libraries(provenance, plan.libraries);
      if (!unit.runs.empty()) run.predecessor = unit.runs.back();
      run.hash =
          identity.of(*outcome.composition, provenance, run.predecessor < 0 ? "" : plan.runs[at(run.predecessor)].hash);
      unit.runs.push_back(r);
    }
    if (!unit.runs.empty()) plan.units.push_back(std::move(unit));
  }
  Judge(plan, readings).judge(refusal);
  if (!refusal.any()) check_reference(plan, refusal);
  if (refusal.any()) return std::nullopt;
  return plan;
}

void check_values(StudyFile study, Registry& registry, Refusal& refusal) {
  if (study.axes.empty() || request_of(study, std::vector<int>(study.axes.size(), 0)).file.empty()) return;
  study.reference = {};
  double runs = 1.0;
  for (const AxisGroup& group : study.groups) runs *= group.count;
  if (runs > most_checked_runs) study.combination = Combination::one_at_a_time;
  make_plan(std::move(study), registry, refusal);
}

}  // namespace bowstring::study
