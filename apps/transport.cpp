#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include "apps/commands.hpp"
#include "apps/given_file.hpp"
#include "apps/outputs.hpp"
#include "apps/shell.hpp"
#include "core/composition/nearest.hpp"
#include "core/measure/given_measure.hpp"
#include "core/result/provenance.hpp"
#include "core/transport/certificate.hpp"
#include "core/transport/transport_document.hpp"

namespace bowstring::apps {

namespace {

using Clock = std::chrono::steady_clock;

constexpr long repeat_seed = 1;

CurveSampling sampling_of(const TransportOptions& options) {
  CurveSampling out;
  out.points = options.points;
  read_curve_weights(options.weights.c_str(), out.weights);
  return out;
}

/// Reads one side; what is wrong goes into `refusal`. False where it is not there.
bool read_side(const std::string& text, const TransportOptions& options, TransportSide& side, Refusal& refusal) {
  const MeasureName name = measure_name(text);
  std::string content;
  if (!read_given_file(name.file, content, refusal)) return false;
  const std::optional<GivenMeasure> given = read_given_measure(name, content, refusal.errors);
  if (!given) return false;
  std::optional<CurveMeasure> measure =
      measure_of(*given, sampling_of(options), options.weights.empty(), refusal.errors);
  if (!measure) return false;
  side.name = text;
  side.file = std::filesystem::absolute(name.file).lexically_normal().string();
  side.sha256 = given->sha256;
  side.is_curve = given->is_curve;
  side.measure = std::move(measure->measure);
  side.arc = std::move(measure->arc);
  return true;
}

/// What only makes sense of curves, where there are none.
void check_sampling(const TransportOptions& options, const TransportReport& report, Refusal& refusal) {
  if (report.a.is_curve || report.b.is_curve) return;
  for (const auto& [given, option] :
       {std::pair(options.points > 0, "--points"), {!options.weights.empty(), "--weights"}}) {
    if (!given) continue;
    refusal.errors.push_back({option, "neither measure is a curve", "a curve to be sampled",
                              "write '" + options.a +
                                  "#curve' where the rows of the file are a curve in order, or leave " + option +
                                  " out"});
  }
}

void check_frames(const TransportComparison& comparison, const TransportSide& side, Refusal& refusal) {
  if (!comparison.ground_cost().needs_frames() || side.measure.has_frames()) return;
  refusal.errors.push_back(
      {side.name,
       "places without orientations, and the ground cost '" + comparison.choice().cost.name + "' compares frames",
       "columns qw, qx, qy, qz, or a curve",
       "add the columns, write '" + side.name +
           "#curve' where the rows are a curve in order, or choose --cost euclidean"});
}

/// A refusal of what the kernel or a method says of both measures.
Refusal refusal_of(const TransportOptions& options, const Status& status) {
  Refusal out;
  if (status.code == Code::invalid_input || status.code == Code::unsupported) {
    out.errors.push_back({options.a + ", " + options.b, status.text, "", ""});
  } else {
    out.plugin_failure = status;
  }
  return out;
}

double mass_of(const TransportSide& side) {
  return std::accumulate(side.measure.weight.begin(), side.measure.weight.end(), 0.0);
}

void line(const char* label, const std::string& text) { std::printf("  %-22s %s\n", label, text.c_str()); }

std::string with_unit(double value, const std::string& unit, int digits = 10) {
  return number(value, digits) + (unit.empty() ? "" : " " + unit);
}

std::string milliseconds(double seconds) { return number(1e3 * seconds, 3) + " ms"; }

std::string places_text(const TransportSide& side) {
  return side.name + " (" + (side.is_curve ? "curve, " : "") +
         counted(static_cast<int>(side.measure.count()), "place") + ")";
}

std::string certificate_text(const TransportReport& report) {
  const TransportAnswer& answer = report.result.answer;
  if (!answer.certified) return "none: the method proves nothing of its plan";
  const TransportCertificate& certificate = answer.certificate;
  return std::string(certificate_holds(certificate, mass_of(report.a)) ? "holds" : "DOES NOT HOLD") + ": marginals " +
         number(std::max(certificate.marginal_a, certificate.marginal_b), 2) + ", duals " +
         with_unit(certificate.dual_violation, report.result.cost_unit, 2) + ", gap " +
         with_unit(certificate.gap, report.result.cost_unit, 2);
}

std::string uniqueness_text(const TransportReport& report) {
  const TransportAnswer& answer = report.result.answer;
  if (!answer.uniqueness_known) return "not known";
  const std::string slack = ", slack " + with_unit(answer.slack, report.result.cost_unit, 4);
  return (answer.multiple ? "no, another plan has the same value" : "yes") + slack;
}

void print_repeat(const RepeatRecord& repeat) {
  const auto times = [](const Spread& spread) {
    return "median " + milliseconds(spread.median) + ", " + milliseconds(spread.least) + " to " +
           milliseconds(spread.most);
  };
  std::printf("%s after steps of %s mm\n", counted(repeat.count, "comparison").c_str(), number(repeat.step, 4).c_str());
  line("warm", times(repeat.warm) + "; " + number(repeat.iterations.median) + " iterations");
  line("cold", times(repeat.cold) + "; " + number(repeat.cold_iterations.median) + " iterations");
}

void print_table(const TransportReport& report) {
  const TransportResult& result = report.result;
  const TransportAnswer& answer = result.answer;
  const std::string& unit = result.cost_unit;
  std::printf("%s with %s: %s to %s\n", report.choice.method.name.c_str(), report.choice.cost.name.c_str(),
              places_text(report.a).c_str(), places_text(report.b).c_str());
  line("value", with_unit(answer.value, unit));
  if (answer.value >= 0.0 && (unit.empty() || unit == "mm^2")) {
    line("its root, a distance", with_unit(std::sqrt(answer.value), unit.empty() ? "" : "mm", 6));
  }
  if (answer.transport_cost != answer.value) line("cost of the plan", with_unit(answer.transport_cost, unit));
  line("plan", std::to_string(answer.plan.value.size()) + " of " +
                   std::to_string(report.a.measure.count() * report.b.measure.count()) + " entries are not zero");
  line("certificate", certificate_text(report));
  if (!answer.certified) line("gap", with_unit(answer.gap, unit, 3));
  line("the only plan", uniqueness_text(report));
  for (const auto& [name, value] : answer.figures) line(name.c_str(), number(value, 6));
  line("iterations", std::to_string(answer.iterations) + ", " + std::to_string(result.costs_evaluated) +
                         " costs evaluated, " + number(static_cast<double>(answer.memory_bytes) / 1048576.0, 3) +
                         " MiB");
  line("time", "read " + milliseconds(report.read_seconds) + ", cost " + milliseconds(result.cost_seconds) +
                   ", solve " + milliseconds(result.solve_seconds));
  if (report.repeat) print_repeat(*report.repeat);
}

}  // namespace

int transport(const CommonOptions& common, const TransportOptions& options) {
  TransportRequest request{options.method, options.cost, {}};
  if (!parse_overrides(options.set, request.settings)) return exit_wrong_input;
  PluginHost host = make_host(common, "");
  Outputs outputs;
  if (const int code = outputs.prepare(options.out, options.write, host); code != exit_converged) return code;

  TransportReport report;
  Refusal refusal;
  std::optional<TransportComparison> comparison = TransportComparison::open(request, host, refusal);
  const Clock::time_point start = Clock::now();
  const bool a = read_side(options.a, options, report.a, refusal), b = read_side(options.b, options, report.b, refusal);
  report.read_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (a && b) check_sampling(options, report, refusal);
  if (comparison && a) check_frames(*comparison, report.a, refusal);
  if (comparison && b) check_frames(*comparison, report.b, refusal);
  if (refusal.any()) return apps::report(refusal);
  if (const int code = outputs.spare({report.a.file, report.b.file}, "this command"); code != exit_converged) {
    return code;
  }

  report.choice = comparison->choice();
  Status status = comparison->compare(report.a.measure, report.b.measure, report.result);
  if (status.ok() && options.repeat > 0) {
    report.repeat.emplace();
    status =
        repeat_comparison(*comparison, report.a.measure, report.b.measure, options.repeat, repeat_seed, *report.repeat);
  }
  if (!status.ok()) return apps::report(refusal_of(options, status));
  report.provenance = provenance_json(provenance_of({&report.choice.method, &report.choice.cost}, host));

  const std::string document = transport_document(report);
  const int written = outputs.write(document);
  if (options.json) {
    std::fwrite(document.data(), 1, document.size(), stdout);
  } else {
    print_table(report);
  }
  if (written != exit_converged) return written;
  return flushed(certificate_holds(report.result.answer, mass_of(report.a)) ? exit_converged : exit_fell_short);
}

}  // namespace bowstring::apps
