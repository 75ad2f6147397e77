// What a study adds to solving: its runs solved and stored, against the same compositions solved in a plain loop, in
// one process and in turn. Milliseconds per run, medians over rounds, and as a share of the plain loop.
//
// Arguments: the folder of scenes, and optionally the number of rounds (5) and a folder for the studies.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include "core/procedure/procedure.hpp"
#include "plugins/host/plugin_host.hpp"
#include "study/plan/plan.hpp"
#include "study/store/folder.hpp"
#include "study/workers/run_solver.hpp"

namespace {

using namespace bowstring;

constexpr int runs = 40;

double seconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

study::Plan planned(const std::string& scenes, const std::string& solver, const std::filesystem::path& folder,
                    PluginHost& host) {
  const std::string file = (folder / (solver + ".toml")).string();
  std::ofstream(file) << "schema = 1\nbase = \"" << scenes << "/planar-iliac-smooth.toml\"\n[set]\n\"solver.type\" = \""
                      << solver << "\"\n[axes]\nT = { path = \"energy.axial-tension.tension\", linear = [\"5 N\", "
                      << "\"15 N\"], count = " << runs << " }\n";
  Refusal refusal;
  study::StudyFile study = study::read_study(file, false, refusal.errors);
  std::optional<study::Plan> plan = study::make_plan(std::move(study), host, refusal);
  if (refusal.any()) throw std::runtime_error(refusal.text());
  return std::move(*plan);
}

void solve_plainly(const study::Plan& plan, PluginHost& host) {
  for (const study::PlannedRun& run : plan.runs) {
    Refusal refusal;
    const auto procedure = Procedure::prepare(study::request_of(plan.study, run.choice), host, refusal);
    if (procedure == nullptr) throw std::runtime_error(refusal.text());
    procedure->run({});
  }
}

/// Seconds of it that files took: what a file system makes of them differs a lot.
double solve_as_study(const study::Plan& plan, const study::Folder& folder, bool documents, PluginHost& host) {
  double storing = 0.0;
  for (std::size_t r = 0; r < plan.runs.size(); ++r) {
    const study::SolvedRun solved =
        study::solve_run(plan, static_cast<int>(r), nullptr, documents, host, [] { return true; });
    storing += seconds_of([&] {
      const Status status = folder.store(solved.record, solved.document);
      if (!status.ok()) throw std::runtime_error(status.text);
    });
  }
  return storing;
}

void measure(const std::string& scenes, const std::string& solver, int rounds, const std::filesystem::path& root) {
  PluginHost host;
  std::vector<double> plan_times, plain, summary, full, storing;
  for (int round = 0; round < rounds; ++round) {
    study::Plan plan;
    plan_times.push_back(seconds_of([&] { plan = planned(scenes, solver, root, host); }));
    const study::Folder folder((root / (solver + std::to_string(round))).string());
    if (!folder.make().ok()) throw std::runtime_error("no folder");
    plain.push_back(seconds_of([&] { solve_plainly(plan, host); }));
    summary.push_back(seconds_of([&] { storing.push_back(solve_as_study(plan, folder, false, host)); }));
    full.push_back(seconds_of([&] { solve_as_study(plan, folder, true, host); }));
  }
  const auto per_run = [](const std::vector<double>& times) { return 1e3 * median(times) / runs; };
  const auto added = [&](const std::vector<double>& times) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < times.size(); ++i) differences.push_back(times[i] - plain[i] + plan_times[i]);
    return per_run(differences);
  };
  std::printf("| %s | %.2f | %.2f (%.1f %%) | %.2f | %.2f | %.2f (%.1f %%) |\n", solver.c_str(), per_run(plain),
              added(summary), 100.0 * added(summary) / per_run(plain), per_run(plan_times), per_run(storing),
              added(full), 100.0 * added(full) / per_run(plain));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  const std::filesystem::path root =
      (argc > 3 ? std::filesystem::path(argv[3]) : std::filesystem::temp_directory_path()) /
      ("bowstring-overhead-" + std::to_string(::getpid()));
  std::filesystem::create_directories(root);
  std::printf("planar-iliac-smooth, N = 80, ms per run, medians of %d rounds of %d runs\n\n", rounds, runs);
  std::printf(
      "| solver | plain loop | added by `--keep summary` | of it planning | of it files | added by `--keep full` |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const char* solver : {"interior-point", "ipopt"})
    measure(std::filesystem::absolute(argv[1]).string(), solver, rounds, root);
  std::filesystem::remove_all(root);
}
