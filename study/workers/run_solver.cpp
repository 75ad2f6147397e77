#include "study/workers/run_solver.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/composition/sha256.hpp"
#include "core/procedure/procedure.hpp"
#include "core/result/carry.hpp"
#include "core/result/document.hpp"
#include "core/simulation/document_path.hpp"

namespace bowstring::study {
namespace {

using Json = nlohmann::ordered_json;
using Reduction = QuantityOfInterest::Reduction;

constexpr const char* carried_name = "the run before";

std::string host_name() {
  char name[256] = "";
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

double peak_memory_MB() {
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::optional<double> finite(const Json& value) {
  return value.is_number() && std::isfinite(value.get<double>()) ? std::optional<double>(value.get<double>())
                                                                 : std::nullopt;
}

void add_numbers(const Json& value, std::vector<double>& out) {
  if (value.is_array()) {
    for (const Json& entry : value) add_numbers(entry, out);
  } else if (const std::optional<double> number = finite(value)) {
    out.push_back(*number);
  }
}

std::optional<double> reduced(const std::vector<double>& numbers, Reduction reduction) {
  if (reduction == Reduction::count) return static_cast<double>(numbers.size());
  double sum = 0.0, squares = 0.0;
  for (const double number : numbers) sum += number, squares += number * number;
  if (reduction == Reduction::sum) return sum;
  if (numbers.empty()) return std::nullopt;
  const double count = static_cast<double>(numbers.size());
  switch (reduction) {
    case Reduction::maximum:
      return *std::max_element(numbers.begin(), numbers.end());
    case Reduction::minimum:
      return *std::min_element(numbers.begin(), numbers.end());
    case Reduction::mean:
      return sum / count;
    case Reduction::root_mean_square:
      return std::sqrt(squares / count);
    default:
      return numbers.size() == 1 ? std::optional<double>(numbers.front()) : std::nullopt;
  }
}

std::optional<double> quantity_in(const Json& document, const QuantityOfInterest& quantity, std::string& why) {
  Selection found;
  why = follow_path(document, quantity.path, found);
  if (!why.empty()) return std::nullopt;
  std::vector<double> numbers;
  for (const Json* value : found.values) add_numbers(*value, numbers);
  return reduced(numbers, quantity.reduction);
}

/// Whether a path leads into the tables that every record has.
bool is_scalar_path(const std::string& path) {
  return path.rfind("quantities.", 0) == 0 || path.rfind("certificate.", 0) == 0 || path.rfind("energy.", 0) == 0;
}

void take_scalars(const Json& scalars, RunRecord& record) {
  record.status = scalars["status"].get<std::string>();
  record.reason = scalars["reason"].get<std::string>();
  const Json& certificate = scalars["certificate"];
  if (certificate["second_order"].is_string()) record.second_order = certificate["second_order"].get<std::string>();
  for (const char* key : {"stationarity", "max_penetration_mm", "max_penetration_dense_mm", "complementarity",
                          "min_multiplier", "min_stretch", "max_stretch"}) {
    record.certificate[key] = finite(certificate[key]);
  }
  for (const auto& [term, value] : scalars["energy"].items()) record.energy.emplace_back(term, finite(value));
}

void take_counts(const StateResult& result, RunRecord& record) {
  const SolverResult& solver = result.solution.solver;
  record.unknowns = result.session.problem.unknowns;
  record.iterations = solver.iterations;
  record.factorizations = solver.factorizations;
  record.evaluations = solver.evaluations;
  record.epochs = result.session.epochs;
  record.warnings = result.solution.warnings;
}

void take_seconds(const Seconds& seconds, RunRecord& record) {
  record.solve_seconds.push_back(seconds.solve);
  if (record.solve_seconds.size() > 1) return;
  record.load_seconds = seconds.load;
  record.setup_seconds = seconds.setup;
  record.total_seconds = seconds.total;
}

std::string study_json(const Plan& plan, const RunRecord& record) {
  const Json predecessor = record.predecessor.empty() ? Json(nullptr) : Json(record.predecessor);
  return Json({{"name", plan.study.name}, {"hash", record.hash}, {"predecessor", predecessor}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

RunRecord started(const Plan& plan, int run) {
  const PlannedRun& planned = plan.runs[static_cast<std::size_t>(run)];
  RunRecord record;
  record.hash = planned.hash;
  record.host = host_name();
  record.peak_memory_MB = peak_memory_MB();
  return record;
}

void take_values(const Plan& plan, const Json& scalars, const std::string& document, RunRecord& record) {
  Json whole;
  for (const QuantityOfInterest& quantity : plan.study.quantities) {
    const bool scalar = is_scalar_path(quantity.path);
    if (!scalar && whole.is_null()) whole = Json::parse(document);
    std::string why;
    const std::optional<double> value = quantity_in(scalar ? scalars : whole, quantity, why);
    if (!why.empty()) record.warnings.push_back(why);
    record.values[value_key(quantity)] = value;
  }
}

}  // namespace

std::string value_key(const QuantityOfInterest& quantity) {
  const std::string reduction = reduction_name(quantity.reduction);
  return reduction.empty() ? quantity.path : reduction + " " + quantity.path;
}

std::optional<double> quantity_in(const std::string& document, const QuantityOfInterest& quantity, std::string& why) {
  const Json json = Json::parse(document, nullptr, false);
  return quantity_in(json, quantity, why);
}

std::optional<CarriedState> state_of_document(const std::string& document, std::string& why) {
  std::vector<DocumentFlaw> flaws;
  auto state = std::make_shared<RecordedState>(read_recorded_state(document, carried_name, flaws));
  if (!flaws.empty()) {
    why = flaws.front().found;
    return std::nullopt;
  }
  state->sha256.clear();  // a state in memory has none, and gives the same bits
  CarriedState out;
  out.state = std::move(state);
  out.name = carried_name;
  return out;
}

RunRecord failed_run(const Plan& plan, int run, const std::string& reason) {
  RunRecord record = started(plan, run);
  record.status = "failed";
  record.reason = reason;
  for (const QuantityOfInterest& quantity : plan.study.quantities) record.values[value_key(quantity)] = std::nullopt;
  return record;
}

SolvedRun solve_run(const Plan& plan, int run, const CarriedState* carried, bool with_document, Registry& registry,
                    const std::function<bool()>& go_on) {
  SolvedRun out;
  const CompositionRequest request = request_of(plan.study, plan.runs[static_cast<std::size_t>(run)].choice);
  const auto progress = [&](const IterationRecord&) {
    out.stopped = out.stopped || !go_on();
    return !out.stopped;
  };
  out.record = started(plan, run);
  if (carried != nullptr) {
    const int predecessor = plan.runs[static_cast<std::size_t>(run)].predecessor;
    out.record.predecessor = plan.runs[static_cast<std::size_t>(predecessor)].hash;
  }
  std::string first_scalars;
  for (int repeat = 0; repeat < plan.study.repeats && !out.stopped; ++repeat) {
    Refusal refusal;
    const std::unique_ptr<Procedure> procedure = Procedure::prepare(request, registry, refusal, carried);
    const Composition* composition = procedure != nullptr ? &procedure->session().composition : nullptr;
    if (repeat == 0 && hash_now(plan, run, composition, registry) != out.record.hash) {
      out.problem = "files of the run " + run_label(plan.study, plan.runs[static_cast<std::size_t>(run)].choice) +
                    " have changed since the study was read; the same command begins with them as they are";
      return out;
    }
    if (procedure == nullptr) {
      out.record = failed_run(plan, run, refusal_reason(plan.study, refusal));
      out.record.status = "refused";
      return out;
    }
    const std::vector<StateResult> states = procedure->run(progress);
    const StateResult& result = states.back();
    take_seconds(result.session.seconds, out.record);
    const std::string scalars = result_scalars(result);
    if (repeat > 0) {
      if (scalars != first_scalars) out.record.warnings.emplace_back("a repeat came out with other numbers");
      continue;
    }
    first_scalars = scalars;
    const bool by_document = std::any_of(plan.study.quantities.begin(), plan.study.quantities.end(),
                                         [](const auto& quantity) { return !is_scalar_path(quantity.path); });
    if (with_document || by_document) out.document = result_document(states, study_json(plan, out.record));
    const Json read = Json::parse(scalars);
    take_scalars(read, out.record);
    take_counts(result, out.record);
    take_values(plan, read, out.document, out.record);
    if (out.record.status == "converged") {
      out.result = carry(result.session, result.solution, result.readings, carried_name);
    }
  }
  if (!with_document) out.document.clear();
  if (!out.document.empty()) out.record.document_sha256 = sha256_hex(out.document);
  out.record.peak_memory_MB = peak_memory_MB();
  return out;
}

}  // namespace bowstring::study
