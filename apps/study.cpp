#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/shell.hpp"
#include "apps/stop_signals.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/read_file.hpp"
#include "core/result/write_file.hpp"
#include "study/analysis/analysis.hpp"
#include "study/plan/plan.hpp"
#include "study/report/report_json.hpp"
#include "study/report/report_page.hpp"
#include "study/results/collect.hpp"
#include "study/results/collect_shapes.hpp"
#include "study/results/results_table.hpp"
#include "study/store/folder.hpp"
#include "study/workers/pool.hpp"

namespace bowstring::apps {

namespace {

using study::Collected;
using study::Folder;
using study::Plan;
using study::PoolOptions;
using study::PoolOutcome;
using study::PoolProgress;

/// "12 s", "3 min 20 s", "2 h 5 min".
std::string duration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

/// One line that is drawn over and over on a terminal; a line now and then elsewhere.
class ProgressLine {
 public:
  void operator()(const PoolProgress& now) {
    if (now.seconds < next_) return;
    next_ = now.seconds + (terminal_ ? 0.1 : 30.0);
    if (!terminal_ && now.seconds < 1.0) return;
    std::fprintf(stderr, "%s%s%s", terminal_ ? "\r\033[K" : "", text(now).c_str(), terminal_ ? "" : "\n");
    std::fflush(stderr);
  }
  void finish() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  static std::string text(const PoolProgress& now) {
    std::string out = std::to_string(now.done) + " of " + counted(now.runs, "run");
    if (now.solved == 0) return out;
    const double rate = now.solved / now.seconds;
    out += "   " + number(rate, 3) + " a second   " + duration((now.runs - now.done) / rate) + " left";
    if (now.converged < now.solved) out += "   " + std::to_string(now.solved - now.converged) + " not converged";
    return out;
  }

  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  double next_ = 0.0;
};

bool parse_shard(const std::string& text, PoolOptions& out) {
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.shard);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, out.shards);
    if (second.ec == std::errc() && second.ptr == end && out.shard >= 1 && out.shard <= out.shards) return true;
  }
  complain("--shard " + text + ": found no part of a whole; expected i/n with i from 1 to n, for instance --shard 2/4");
  return false;
}

/// Prepares everything that is checked before anything runs. Empty with `code` set where something is wrong.
std::optional<Plan> prepare(const CommonOptions& common, const StudyOptions& options, const Folder& folder,
                            std::unique_ptr<PluginHost>& host, int& code) {
  Refusal refusal;
  study::StudyFile file = study::read_study(options.file, options.reduced, refusal.errors);
  host.reset(new PluginHost(make_host(common, study::bases_of(file))));
  std::optional<Plan> plan;
  if (refusal.any()) {
    study::check_values(std::move(file), *host, refusal);
  } else {
    folder.check(file.name, !options.check, refusal.errors);
    plan = study::make_plan(std::move(file), *host, refusal);
  }
  if (!refusal.any()) return plan;
  code = report(refusal);
  return std::nullopt;
}

int verify(const Plan& plan, const Folder& folder) {
  std::vector<std::string> problems = folder.problems(plan);
  std::string stored;
  const std::string table = folder.file("results.csv");
  const Collected collected = study::collect(plan, folder);
  if (problems.empty()) problems = collected.problems;
  if (const std::string why = read_file(table, stored); !why.empty()) {
    problems.push_back(table + ": cannot be read (" + why + "); the same command without --check writes it");
  } else if (problems.empty() && stored != study::results_csv(collected)) {
    problems.push_back(table + ": differs from what the runs say; the same command without --check writes it anew");
  }
  for (const std::string& problem : problems) complain(problem);
  std::printf("%s checked: %s\n", counted(static_cast<int>(plan.runs.size()), "run").c_str(),
              problems.empty() ? "all whole, results.csv is theirs"
                               : counted(static_cast<int>(problems.size()), "problem").c_str());
  if (const int strangers = folder.strangers(plan); strangers > 0) {
    std::printf("%s in runs/ belong to no run of this study\n", counted(strangers, "other result").c_str());
  }
  return problems.empty() ? exit_converged : exit_fell_short;
}

void print_counts(const Plan& plan, const Collected& collected) {
  std::map<std::string, int> count;
  for (const study::RunData& run : collected.data.runs) ++count[run.status];
  std::string text;
  for (const auto& [status, runs] : count) text += (text.empty() ? "" : ", ") + std::to_string(runs) + " " + status;
  std::printf("%s: %s, %s\n", collected.data.title.c_str(), counted(static_cast<int>(plan.runs.size()), "run").c_str(),
              text.c_str());
}

/// A path that leads nowhere shows when all is solved: then the study file can be mended without solving again.
void warn_of_missing(const Collected& collected) {
  const auto known = [](double value) { return std::isfinite(value); };
  for (const study::QuantityData& quantity : collected.data.quantities) {
    if (std::any_of(quantity.value.begin(), quantity.value.end(), known)) continue;
    std::fprintf(stderr, "warning: no run has a value of '%s' (%s); is the path right?\n", quantity.column.c_str(),
                 quantity.path.c_str());
  }
}

/// results.csv and report.html; "" or why not.
Status write_tables(const Plan& plan, const Folder& folder, const Collected& collected) {
  const Status status = write_file(folder.file("results.csv"), study::results_csv(collected));
  if (!status.ok()) return status;
  const study::Analysis analysis = study::analyse(collected.data);
  const study::Shapes shapes = study::collect_shapes(plan, collected, folder);
  const std::string page = study::report_page(study::report_json(collected.data, analysis, shapes));
  print_counts(plan, collected);
  warn_of_missing(collected);
  for (const study::Headline& headline : analysis.headlines) std::printf("  %s\n", headline.text.c_str());
  return write_file(folder.file("report.html"), page);
}

/// Of all runs: whoever comes last among several commands sees them all.
int write_results(const Plan& plan, const Folder& folder, study::Claims& claims) {
  claims.take_folder();
  const Collected collected = study::collect(plan, folder);
  Status status;
  if (collected.problems.empty()) {
    status = write_tables(plan, folder, collected);
  } else {
    std::printf("%zu of %s there; results.csv and report.html come with the last one\n",
                plan.runs.size() - collected.problems.size(),
                counted(static_cast<int>(plan.runs.size()), "run").c_str());
  }
  claims.leave_folder();
  if (!status.ok()) {
    complain(status.text);
    return exit_wrong_input;
  }
  if (collected.problems.empty()) {
    std::printf("  %s\n  %s\n", folder.file("results.csv").c_str(), folder.file("report.html").c_str());
  }
  return exit_converged;
}

}  // namespace

int study(const CommonOptions& common, const StudyOptions& options) {
  PoolOptions pool;
  if (!parse_shard(options.shard, pool)) return exit_wrong_input;
  pool.jobs = options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  pool.keep_documents = options.keep == "full";
  const Folder folder(options.out);
  std::unique_ptr<PluginHost> host;
  int code = exit_converged;
  const std::optional<Plan> plan = prepare(common, options, folder, host, code);
  if (!plan) return code;
  if (options.check) return verify(*plan, folder);
  study::Claims claims;
  Status status = folder.make();
  if (status.ok()) status = claims.open(folder.file("claims.lock"));
  if (status.ok()) {
    claims.take_folder();
    status = folder.write_lock(*plan, options.reduced);
    claims.leave_folder();
  }
  if (!status.ok()) {
    complain(status.text);
    return exit_wrong_input;
  }
  folder.sweep(claims);

  ProgressLine line;
  PoolOutcome outcome;
  {
    const StopSignals signals({SIGINT, SIGTERM});
    outcome = study::run_pool(*plan, folder, *host, pool, StopSignals::seen(), std::ref(line));
  }
  line.finish();
  for (const std::string& problem : outcome.problems) complain(problem);
  if (outcome.stopped || !outcome.problems.empty()) {
    std::fprintf(stderr, "stopped: %d of %s there; the same command goes on from here\n",
                 outcome.found + outcome.solved, counted(outcome.runs, "run").c_str());
    return outcome.problems.empty() ? exit_fell_short : exit_wrong_input;
  }
  return write_results(*plan, folder, claims);
}

}  // namespace bowstring::apps
