#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <optional>

#include <unistd.h>

#include "apps/outputs.hpp"
#include "apps/shell.hpp"
#include "core/result/solved.hpp"

namespace bowstring::apps {

namespace {

std::atomic<bool> interrupted{false};

extern "C" void on_interrupt(int) { interrupted.store(true); }

/// One line that is drawn over and over on a terminal; silent elsewhere.
class Progress {
 public:
  bool operator()(const IterationRecord& record) {
    if (terminal_) {
      std::fprintf(stderr, "\r\033[Kiteration %3d   energy %.6g N mm   stationarity %.1e N   rows %.1e mm   step %.2g",
                   record.iteration, record.energy, record.stationarity, record.penetration, record.step);
      std::fflush(stderr);
    }
    return !interrupted.load();
  }
  void finish() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

void line(const char* label, const std::optional<double>& value, const char* unit) {
  if (value && std::isfinite(*value)) std::printf("  %-26s %12s %s\n", label, number(*value, 6).c_str(), unit);
}

void print_table(const Session& session, const Solution& solution, const Readings& readings) {
  const Certificate& certificate = solution.certificate;
  if (!session.composition.title.empty()) std::printf("%s\n", session.composition.title.c_str());
  std::printf("%s: %s\n", verdict_name(certificate.verdict), certificate.reason.c_str());
  std::printf("  %s, %s, %s; load %.0f ms, set-up %.0f ms, solve %.0f ms\n",
              counted(solution.solver.iterations, "iteration").c_str(),
              counted(session.assembly->epochs(), "epoch").c_str(),
              counted(session.assembly->unknowns(), "unknown").c_str(), 1e3 * session.seconds.load,
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
  const std::unique_ptr<Session> session = prepare(request, host, refusal);
  if (session == nullptr) return report(refusal);
  if (const int code = outputs.spare(session->composition.input_files); code != exit_converged) return code;

  std::signal(SIGINT, on_interrupt);
  Progress progress;
  const Solved solved = solve_and_read(*session, host, std::ref(progress));
  progress.finish();
  std::signal(SIGINT, SIG_DFL);

  if (!solved.readable.ok()) complain(solved.readable.text);
  const int written = outputs.write(solved.document);  // before anything is printed: a pipe may be closed by now
  if (options.json) {
    std::fwrite(solved.document.data(), 1, solved.document.size(), stdout);
  } else {
    print_table(*session, solved.solution, solved.readings);
  }
  for (const std::string& warning : solved.solution.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (written != exit_converged) return written;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    complain("stdout cannot be written");
    return exit_fell_short;
  }
  return solved.solution.certificate.verdict == Verdict::converged ? exit_converged : exit_fell_short;
}

}  // namespace bowstring::apps
