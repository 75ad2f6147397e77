#include "core/transport/transport_comparison.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/composition/components.hpp"
#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/report.hpp"
#include "core/composition/toml_text.hpp"
#include "core/transport/check_answer.hpp"
#include "core/transport/check_measure.hpp"
#include "core/transport/pair_costs.hpp"

namespace bowstring {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::vector<std::string> keys_of(const ComponentDescriptor* descriptor) {
  std::vector<std::string> keys;
  for (int k = 0; descriptor != nullptr && k < descriptor->parameter_count; ++k) {
    keys.emplace_back(descriptor->parameters[k].key);
  }
  return keys;
}

Position position_of(const Override& setting, int order) {
  auto source = std::make_shared<Source>();
  source->name = setting.position.empty() ? "--set " + setting.path + "=" + setting.value : setting.position;
  source->directory =
      setting.directory.empty() ? std::filesystem::current_path() : std::filesystem::path(setting.directory);
  source->order = order;
  return {std::move(source), 0, 0};
}

/// The table of a component of that name, without settings yet.
Node named_table(const char* option, const std::string& name) {
  const Position position = position_of({"", "", std::string("--") + option + " " + name}, 0);
  Node table;
  table.position = position;
  table.set({"type", position, text_node(name, position)});
  return table;
}

/// Gives each setting to the component that declares its key, or to both.
void place_settings(const TransportRequest& request, const std::vector<std::string>& of_method,
                    const std::vector<std::string>& of_cost, Node& method, Node& cost, Report& report) {
  std::vector<std::string> all = of_method;
  all.insert(all.end(), of_cost.begin(), of_cost.end());
  int order = 0;
  for (const Override& setting : request.settings) {
    const Position position = position_of(setting, ++order);
    const bool in_method = contains_name(of_method, setting.path), in_cost = contains_name(of_cost, setting.path);
    const Entry entry{setting.path, position, read_value_or_text(setting.value, position)};
    if (in_method) method.set(entry);
    if (in_cost) cost.set(entry);
    if (in_method || in_cost) continue;
    const std::vector<std::string> near = nearest_names(setting.path, all);
    report.error(position,
                 "unknown key '" + setting.path + "' of transport '" + request.method + "' and ground-cost '" +
                     request.cost + "'",
                 all.empty() ? "no key: they have none" : "one of: " + comma_separated(all),
                 near.empty() ? "`bowstring describe transport/" + request.method +
                                    "` and `bowstring describe ground-cost/" + request.cost + "` explain them"
                              : did_you_mean(near));
  }
}

ComponentUse use_of(Kind kind) {
  ComponentUse use;
  use.kind = kind;
  use.owner = std::string(kind_name(kind));
  use.structural = {"type"};
  use.owner_names_type = true;
  return use;
}

ComponentChoice read_choice(const Node& table, Kind kind, Reading& reading) {
  ComponentUse use = use_of(kind);
  use.owner += " '" + table.text_at("type") + "'";
  return read_component(table, use, reading);
}

const ComponentDescriptor* known(Registry& registry, Kind kind, const std::string& name) {
  Status status;
  return registry.find(kind, name, status);
}

Status flawed(const char* which, const MeasureFlaw& flaw) {
  const std::string place = flaw.index < 0 ? "" : ", place " + std::to_string(flaw.index);
  return Status::failure(Code::invalid_input, std::string("the ") + which + " measure" + place + ": " + flaw.found +
                                                  "; expected " + flaw.expected + "; " + flaw.mend);
}

/// None is NaN or −∞. In two lanes, which compilers take at once: a warm solve takes little longer than this.
bool all_usable(Span<const double> cost) {
  constexpr std::size_t lanes = 2;
  double unusable[lanes] = {};
  std::size_t k = 0;
  for (; k + lanes <= cost.size(); k += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      unusable[lane] = cost[k + lane] > -HUGE_VAL ? unusable[lane] : 1.0;
    }
  }
  for (; k < cost.size(); ++k) unusable[0] = cost[k] > -HUGE_VAL ? unusable[0] : 1.0;
  return std::all_of(unusable, unusable + lanes, [](double lane) { return lane == 0.0; });
}

Status unusable(Span<const double> cost, std::size_t columns) {
  std::size_t k = 0;
  while (cost[k] > -HUGE_VAL) ++k;
  return Status::failure(Code::invalid_input,
                         "the cost of row " + std::to_string(k / columns) + ", column " + std::to_string(k % columns) +
                             " is not a number; expected a finite one, or +inf for a forbidden pair");
}

Status check_sums(const std::vector<double>& weight_a, const std::vector<double>& weight_b, bool lets_mass_go) {
  const std::string mismatch = lets_mass_go ? "" : sum_mismatch(weight_a, weight_b);
  if (mismatch.empty()) return {};
  return Status::failure(Code::invalid_input, mismatch +
                                                  "; expected equal sums; divide each weight by the sum of its "
                                                  "measure, or choose the method 'unbalanced'");
}

/// What the method says of itself, or what is wrong with its answer all the same.
Status judged(const Status& status, const TransportAnswer& answer, const TransportChoice& choice, std::size_t count_a,
              std::size_t count_b) {
  if (!status.ok()) return status;
  const std::string flaw = flaw_of(answer, count_a, count_b);
  return flaw.empty() ? status : Status::failure(Code::failed, "transport '" + choice.method.name + "': " + flaw);
}

}  // namespace

std::optional<TransportChoice> choose_transport(const TransportRequest& request, Registry& registry, Refusal& refusal) {
  Report report;
  Reading reading{registry, report, refusal.plugin_failure};
  Node method = named_table("method", request.method), cost = named_table("cost", request.cost);
  const ComponentDescriptor* of_method = known(registry, Kind::transport, request.method);
  const ComponentDescriptor* of_cost = known(registry, Kind::ground_cost, request.cost);
  if (of_method != nullptr && of_cost != nullptr) {
    place_settings(request, keys_of(of_method), keys_of(of_cost), method, cost, report);
  }
  TransportChoice choice;
  choice.method = read_choice(method, Kind::transport, reading);
  choice.cost = read_choice(cost, Kind::ground_cost, reading);
  refusal.errors = report.sorted();
  if (refusal.any()) return std::nullopt;
  return choice;
}

TransportComparison::TransportComparison(TransportChoice choice, Owned<Transport> method, Owned<GroundCost> cost)
    : choice_(std::move(choice)), method_(std::move(method)), cost_(std::move(cost)) {}

std::optional<TransportComparison> TransportComparison::open(const TransportRequest& request, Registry& registry,
                                                             Refusal& refusal) {
  const std::optional<TransportChoice> choice = choose_transport(request, registry, refusal);
  if (!choice) return std::nullopt;
  Status status;
  std::optional<TransportComparison> out = open(*choice, status);
  if (!out && status.code == Code::invalid_input) {
    refusal.errors.push_back({"", status.text, "", ""});
  } else if (!out) {
    refusal.plugin_failure = status;
  }
  return out;
}

std::optional<TransportComparison> TransportComparison::open(const TransportChoice& choice, Status& status) {
  Owned<Transport> method = create<Transport>(choice.method, status);
  if (!status.ok()) return std::nullopt;
  Owned<GroundCost> cost = create<GroundCost>(choice.cost, status);
  if (!status.ok()) return std::nullopt;
  return TransportComparison(choice, std::move(method), std::move(cost));
}

Status TransportComparison::check(const Measure& a, const Measure& b) const {
  const std::pair<const char*, const Measure*> both[] = {{"first", &a}, {"second", &b}};
  for (const auto& [which, measure] : both) {
    const std::vector<MeasureFlaw> flaws = flaws_of(*measure);
    if (!flaws.empty()) return flawed(which, flaws.front());
    if (cost_->needs_frames() && !measure->has_frames()) {
      return flawed(which,
                    {-1, "points without orientations, and the ground cost '" + choice_.cost.name + "' compares frames",
                     "a quaternion w, x, y, z for each place", "give them, or choose the ground cost 'euclidean'"});
    }
  }
  return check_sums(a.weight, b.weight, method_->lets_mass_go());
}

Status TransportComparison::compare(const Measure& a, const Measure& b, TransportResult& out, bool with_gradient) {
  out = {};
  if (const Status status = check(a, b); !status.ok()) return status;
  out.cost_unit = cost_->unit();
  MeasureCosts between(*cost_, a, b), within_a(*cost_, a, a), within_b(*cost_, b, b);
  const Clock::time_point start = Clock::now();
  TransportProblem problem;
  problem.weight_a = a.weight;
  problem.weight_b = b.weight;
  problem.between = &between;
  problem.within_a = &within_a;
  problem.within_b = &within_b;
  problem.a = &a;
  problem.b = &b;
  problem.ground_cost = choice_.cost.name.c_str();
  const Status solved = method_->solve(problem, out.answer);
  const double seconds = since(start);
  const double in_cost = between.seconds() + within_a.seconds() + within_b.seconds();
  out.costs_evaluated = between.evaluated() + within_a.evaluated() + within_b.evaluated();
  out.cost_seconds = cost_->dear() ? 0.0 : in_cost;
  out.solve_seconds = seconds - out.cost_seconds;
  const Status status = judged(solved, out.answer, choice_, a.count(), b.count());
  if (!status.ok() || !with_gradient) return status;
  return place_gradients(*cost_, a, b, out.answer, out.gradient_a, out.gradient_b);
}

Status TransportComparison::compare(Span<const double> weight_a, Span<const double> weight_b, Span<const double> cost,
                                    TransportResult& out) {
  out = {};
  const std::vector<double> a(weight_a.begin(), weight_a.end()), b(weight_b.begin(), weight_b.end());
  Measure places_a{std::vector<double>(3 * a.size(), 0.0), {}, a},
      places_b{std::vector<double>(3 * b.size(), 0.0), {}, b};
  for (const auto& [which, measure] : {std::pair("first", &places_a), std::pair("second", &places_b)}) {
    const std::vector<MeasureFlaw> flaws = flaws_of(*measure);
    if (!flaws.empty()) return flawed(which, flaws.front());
  }
  if (const Status status = check_sums(a, b, method_->lets_mass_go()); !status.ok()) return status;
  if (cost.size() != a.size() * b.size()) {
    return Status::failure(Code::invalid_input, std::to_string(cost.size()) + " costs; expected " +
                                                    std::to_string(a.size()) + " x " + std::to_string(b.size()) +
                                                    ", one for each pair of weights");
  }
  if (!all_usable(cost)) return unusable(cost, b.size());
  MatrixCosts between(cost, static_cast<int>(a.size()), static_cast<int>(b.size()));
  TransportProblem problem;
  problem.weight_a = weight_a;
  problem.weight_b = weight_b;
  problem.between = &between;
  const Clock::time_point start = Clock::now();
  const Status status = method_->solve(problem, out.answer);
  out.solve_seconds = since(start);
  return judged(status, out.answer, choice_, a.size(), b.size());
}

}  // namespace bowstring
