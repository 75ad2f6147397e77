#include "study/plan/plan.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/tree.hpp"
#include "core/result/provenance.hpp"
#include "study/plan/identity.hpp"
#include "study/plan/replace_all.hpp"

namespace bowstring::study {
namespace {

constexpr int most_runs = 1000000;
constexpr double most_checked_runs = 2000.0;  // of a study that is wrong anyway

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Product {
 public:
  explicit Product(const StudyFile& study) : study_(study) {}

  /// With those that are excluded.
  double size() const {
    double all = 1.0, others = 1.0;
    for (const AxisGroup& group : study_.groups) {
      all *= group.count;
      others += group.count - 1;
    }
    return study_.combination == Combination::one_at_a_time ? others : all;
  }

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
    for (std::vector<int> index = start;;) {
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
        if (told.count(error.text()) > 0 || !(all_failed || is_of_the_study(r, error.position))) continue;
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

  /// Whether no run can take what stands there: a value of an axis, a composition, or what all runs have in common. The
  /// numbers of a sample stand in one place and each belongs to one run; there it is the range that no run can take.
  bool is_of_the_study(std::size_t run, const std::string& position) const {
    const std::vector<int>& choice = plan_.runs[run].choice;
    for (std::size_t a = 0; a < choice.size(); ++a) {
      const Axis& axis = plan_.study.axes[a];
      const std::vector<Override>& overrides = axis.overrides[at(choice[a])];
      if (axis.data.spacing != Spacing::sampled &&
          std::any_of(overrides.begin(), overrides.end(), [&](const Override& o) { return o.position == position; })) {
        return in_every_run_with(static_cast<int>(a), choice[a], position);
      }
      const bool other_base = !axis.base[at(choice[a])].empty();
      if (other_base && in_every_run_with(static_cast<int>(a), choice[a], position)) return true;
    }
    return in_every_run_with(-1, 0, position);
  }

  /// `axis`: -1 for all runs. Each answer is found once, for it takes a look at all runs.
  bool in_every_run_with(int axis, int alternative, const std::string& position) const {
    const auto [known, fresh] = found_.emplace(std::make_tuple(axis, alternative, position), true);
    for (std::size_t r = 0; r < readings_.size() && fresh && known->second; ++r) {
      if (axis < 0 || plan_.runs[r].choice[at(axis)] == alternative) known->second = has_error_at(r, position);
    }
    return known->second;
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
  mutable std::map<std::tuple<int, int, std::string>, bool> found_;
};

/// A run as the files say it: its composition, once for each [[step]].
struct ReadRun {
  std::vector<Composition> states;  ///< empty where `refusal` has got something
  Provenance provenance;            ///< of all of them
  Refusal refusal;
};

void add_plugins(const Provenance& more, Provenance& provenance) {
  for (const PluginProvenance& plugin : more.plugins) {
    const auto same = [&](const PluginProvenance& one) { return one.kind == plugin.kind && one.name == plugin.name; };
    if (std::none_of(provenance.plugins.begin(), provenance.plugins.end(), same)) provenance.plugins.push_back(plugin);
  }
}

ReadRun read_run(const CompositionRequest& request, Registry& registry) {
  ReadRun out;
  std::size_t steps = 1;
  for (std::size_t k = 0; k < steps && !out.refusal.any(); ++k) {
    CompositionRequest one = request;
    one.step = static_cast<int>(k);
    one.from_memory = request.from_memory || k > 0;
    CompositionOutcome outcome = load_composition(one, registry);
    out.refusal = {std::move(outcome.errors), outcome.plugin_failure};
    if (!outcome.composition) break;
    steps = std::max(steps, outcome.composition->steps.size());
    Provenance provenance = provenance_of(*outcome.composition, registry);
    if (k == 0) {
      out.provenance = std::move(provenance);
    } else {
      add_plugins(provenance, out.provenance);
    }
    out.states.push_back(std::move(*outcome.composition));
  }
  if (out.refusal.any()) out.states.clear();
  return out;
}

void note_libraries(const Provenance& provenance, std::map<std::string, std::string>& libraries) {
  libraries["kernel"] = provenance.kernel_sha256;
  for (const PluginProvenance& plugin : provenance.plugins) {
    libraries[std::string(kind_name(plugin.kind)) + "/" + plugin.name] = plugin.origin.sha256;
  }
}

std::string predecessor_hash(const Plan& plan, const PlannedRun& run) {
  return run.predecessor < 0 ? "" : plan.runs[at(run.predecessor)].hash;
}

/// Chains along the warm axis: the runs that agree in every axis but those walked with it.
std::vector<std::vector<int>> chains_of(const Plan& plan) {
  std::vector<std::vector<int>> chains;
  const StudyFile& study = plan.study;
  std::map<std::vector<int>, std::size_t> place;
  for (std::size_t r = 0; r < plan.runs.size(); ++r) {
    std::vector<int> key = without_walk(study, plan.runs[r].choice, study.warm_along);
    if (study.warm_along < 0) key.push_back(static_cast<int>(r));
    const auto [found, fresh] = place.emplace(std::move(key), chains.size());
    if (fresh) chains.emplace_back();
    chains[found->second].push_back(static_cast<int>(r));
  }
  return chains;
}

/// Where its files stand, as messages begin their names: "/home/somebody/study/". An inner one before an outer one.
std::vector<std::string> folders_of(const StudyFile& study) {
  std::vector<std::string> files = bases_of(study), out;
  files.push_back(study.file);
  std::error_code ignored;
  for (const std::string& file : files) {
    const std::string folder = std::filesystem::absolute(file, ignored).parent_path().lexically_normal().string() + "/";
    if (folder != "/" && !contains_name(out, folder)) out.push_back(folder);
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return out;
}

/// In a run with two other compositions the later axis would undo the earlier one.
void check_bases(const Plan& plan, Refusal& refusal) {
  const std::vector<Axis>& axes = plan.study.axes;
  std::set<std::pair<std::size_t, std::size_t>> told;
  for (const PlannedRun& run : plan.runs) {
    std::optional<std::size_t> first;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (axes[a].base[at(run.choice[a])].empty()) continue;
      if (first && told.emplace(*first, a).second) {
        refusal.errors.push_back(
            {axes[a].position,
             "axes '" + axes[*first].data.name + "' and '" + axes[a].data.name + "' both name the composition of a run",
             "one composition for each run", "make one axis of them, or leave their combinations out"});
      }
      first = a;
    }
  }
}

void check_reference(const Plan& plan, Refusal& refusal) {
  const Reference& reference = plan.study.reference;
  if (reference.axis < 0) return;
  // An extrapolation is made of several meshes, whichever; the finest one is one of them.
  const int finest = plan.study.axes[at(reference.axis)].data.largest();
  std::map<std::vector<int>, int> family;
  const auto reaches = [&](const PlannedRun& run) {
    if (!run.refusal.empty()) return false;
    for (const auto& [axis, alternative] : reference.at) {
      if (run.choice[at(axis)] != alternative) return false;
    }
    if (reference.form == Reference::Form::finest) return run.choice[at(reference.axis)] == finest;
    return ++family[without_walk(plan.study, run.choice, reference.axis)] >= 3;
  };
  if (std::any_of(plan.runs.begin(), plan.runs.end(), reaches)) return;
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

std::vector<int> without_walk(const StudyFile& study, std::vector<int> choice, int axis) {
  for (const int walked : walked_with(study, axis)) choice[at(walked)] = -1;
  return choice;
}

std::string refusal_reason(const StudyFile& study, const Refusal& refusal) {
  std::vector<std::string> texts;
  for (InputError error : refusal.errors) {
    error.position.clear();
    texts.push_back(error.text());
  }
  if (!refusal.plugin_failure.ok()) texts.push_back(refusal.plugin_failure.text);
  std::string out = joined(texts, "; ");
  std::replace(out.begin(), out.end(), '\n', ' ');
  for (const std::string& folder : folders_of(study)) replace_all(out, folder, "");
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

std::string hash_now(const Plan& plan, int run, const Composition* read_just_now, Registry& registry) {
  const PlannedRun& planned = plan.runs[at(run)];
  if (read_just_now != nullptr && read_just_now->steps.empty()) {
    return Identity().of({*read_just_now}, provenance_of(*read_just_now, registry), predecessor_hash(plan, planned));
  }
  const ReadRun read = read_run(request_of(plan.study, planned.choice), registry);
  if (read.states.empty()) return "";
  return Identity().of(read.states, read.provenance, predecessor_hash(plan, planned));
}

std::optional<Plan> make_plan(StudyFile study, Registry& registry, Refusal& refusal) {
  Plan plan;
  plan.study = std::move(study);
  const Product product(plan.study);
  const bool too_many = product.size() > most_runs;
  if (!too_many) {
    for (std::vector<int>& choice : product.choices()) {
      PlannedRun run;
      run.choice = std::move(choice);
      plan.runs.push_back(std::move(run));
    }
  }
  if (plan.runs.empty()) {
    refusal.errors.push_back(
        {plan.study.file,
         too_many ? "the axes make " + decimal(product.size()) + " combinations" : "the exclusions leave no run",
         "between 1 and " + std::to_string(most_runs) + " runs",
         too_many ? "shorten the axes, or take a sample" : "take one back"});
    return std::nullopt;
  }
  check_bases(plan, refusal);
  std::vector<Refusal> readings(plan.runs.size());
  Identity identity;
  for (const std::vector<int>& chain : chains_of(plan)) {
    Unit unit;
    for (const int r : chain) {
      PlannedRun& run = plan.runs[at(r)];
      ReadRun read = read_run(request_of(plan.study, run.choice), registry);
      readings[at(r)] = std::move(read.refusal);
      if (read.states.empty()) {
        run.refusal = refusal_reason(plan.study, readings[at(r)]);
        continue;
      }
      note_libraries(read.provenance, plan.libraries);
      if (!unit.runs.empty()) run.predecessor = unit.runs.back();
      run.hash = identity.of(read.states, read.provenance, predecessor_hash(plan, run));
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
  if (Product(study).size() > most_checked_runs) study.combination = Combination::one_at_a_time;
  if (Product(study).size() > most_checked_runs) return;
  make_plan(std::move(study), registry, refusal);
}

}  // namespace bowstring::study
