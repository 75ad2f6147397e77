#include <cmath>
#include <cstdio>
#include <optional>

#include "apps/outputs.hpp"
#include "apps/shell.hpp"
#include "apps/watched_run.hpp"
#include "core/composition/nearest.hpp"
#include "core/procedure/procedure.hpp"
#include "core/procedure/summary.hpp"
#include "core/result/document.hpp"

namespace bowstring::apps {

namespace {

void line(const char* label, const std::optional<double>& value, const char* unit) {
  if (value && std::isfinite(*value)) std::printf("  %-26s %12s %s\n", label, number(*value, 6).c_str(), unit);
}

void print_path(const Path& path) {
  if (path.value.empty()) return;
  std::printf("path of %s: %s%s\n", path.value.c_str(), counted(static_cast<int>(path.points.size()), "point").c_str(),
              path.reached ? "" : ", which does not arrive");
  for (const CriticalPoint& point : path.critical) {
    std::printf("  %-26s %12s %s, negative directions %d to %d\n", critical_name(point.kind),
                number(point.parameter.front(), 8).c_str(), path.unit.c_str(), point.index_before, point.index_after);
  }
}

void print_equilibria(const std::vector<Equilibrium>& equilibria) {
  if (equilibria.empty()) return;
  std::printf("equilibria\n");
  for (const Equilibrium& one : equilibria) {
    const char* second = curvature_name(one.state.certificate.second_order.curvature);
    std::printf("  %-26s %12s N mm, %s, from %s\n", second == nullptr ? "not judged" : second,
                number(total_energy(one.state), 8).c_str(), one.origin.c_str(), counted(one.basin, "start").c_str());
  }
}

void print_states(const std::vector<StateResult>& states) {
  if (states.front().name.empty()) return;
  std::printf("states\n");
  for (const StateResult& state : states) {
    std::printf("  %-26s %s: %s\n", state.name.c_str(), verdict_name(state.solution.certificate.verdict),
                state.solution.certificate.reason.c_str());
  }
}

void print_table(const StateResult& result) {
  const SessionRecord& session = result.session;
  const Solution& solution = result.solution;
  const Readings& readings = result.readings;
  const Certificate& certificate = solution.certificate;
  if (!session.title.empty()) std::printf("%s\n", session.title.c_str());
  std::printf("%s: %s\n", verdict_name(certificate.verdict), certificate.reason.c_str());
  std::printf("  %s, %s, %s; load %.0f ms, set-up %.0f ms, solve %.0f ms\n",
              counted(solution.solver.iterations, "iteration").c_str(), counted(session.epochs, "epoch").c_str(),
              counted(session.problem.unknowns, "unknown").c_str(), 1e3 * session.seconds.load,
              1e3 * session.seconds.setup, 1e3 * session.seconds.solve);
  std::printf("energy\n");
  double total = 0.0;
  for (std::size_t e = 0; e < readings.term_energy.size(); ++e) {
    line(session.scene->energies[e].label.c_str(), readings.term_energy[e], "N mm");
    total += readings.term_energy[e];
  }
  if (!readings.term_energy.empty()) line("total", total, "N mm");
  const Quantities& q = readings.quantities;
  std::printf("quantities\n");
  line("peak displacement", q.peak_displacement, "mm");
  line("mean displacement", q.mean_displacement, "mm");
  line("wire length", q.wire_length, "mm");
  line("vessel length change", q.vessel_length_change, "mm");
  if (!session.scene->constraints.empty()) {
    std::printf("  %-26s %12d\n", "contacts", q.contact_count);
    line("contact force, sum", q.contact_force, "N");
    line("line load, peak", q.line_load_peak, "N/mm");
  }
  if (!result.losses.empty()) std::printf("losses\n");
  for (const LossRecord& loss : result.losses) {
    if (loss.status.ok()) line(loss.name.c_str(), loss.result.answer.value, loss.result.cost_unit.c_str());
  }
  std::printf("certificate\n");
  line("stationarity", certificate.stationarity, "N");
  line("row penetration", certificate.penetration, "mm");
  line("penetration along the wire", certificate.dense_penetration(), "mm");
  line("complementarity", certificate.complementarity, "N mm");
  if (std::isfinite(certificate.minimum_stretch)) {
    std::printf("  %-26s %12s … %s\n", "vessel stretch ratio", number(certificate.minimum_stretch, 4).c_str(),
                number(certificate.maximum_stretch, 4).c_str());
  }
  const char* second = curvature_name(certificate.second_order.curvature);
  std::printf("  %-26s %12s %s\n", "second order", second == nullptr ? "not judged" : second,
              certificate.second_order.reason.c_str());
}

}  // namespace

int solve(const CommonOptions& common, const SolveOptions& options) {
  CompositionRequest request;
  request.file = options.file;
  if (!parse_overrides(options.set, request.overrides)) return exit_wrong_input;
  PluginHost host = make_host(common, options.file);
  Outputs outputs;
  if (const int code = outputs.prepare(options.out, options.write, host); code != exit_converged) return code;

  Refusal refusal;
  const std::unique_ptr<Procedure> procedure = Procedure::prepare(request, host, refusal);
  if (procedure == nullptr) return report(refusal);
  if (const int code = outputs.spare(procedure->input_files()); code != exit_converged) return code;

  const std::vector<StateResult> states = run_watched(*procedure);
  const StateResult& result = states.back();
  if (!result.readable.ok()) complain(result.readable.text);
  const std::string document = result_document(states);
  const int written = outputs.write(document);  // before anything is printed: a pipe may be closed by now
  if (options.json) {
    std::fwrite(document.data(), 1, document.size(), stdout);
  } else {
    print_table(result);
    print_path(result.path);
    print_equilibria(result.equilibria);
    print_states(states);
  }
  for (const std::string& warning : result.solution.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (written != exit_converged) return written;
  return flushed(result.solution.certificate.verdict == Verdict::converged ? exit_converged : exit_fell_short);
}

}  // namespace bowstring::apps
