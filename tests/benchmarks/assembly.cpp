// Time of one assembly (value, gradient, rows, Jacobian, Hessian of the Lagrangian) by the kernel and by a loop written
// by hand for the scene, per term, as a Markdown table. Both have to give the same numbers before anything is timed.
//
//   benchmark-assembly [PART OF A NAME] [--benchmark_…]   e.g. helical/nodes/80/all
//   benchmark-assembly --compare                          only that they give the same numbers, at the smaller mesh

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <list>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/benchmarks/bench_scene.hpp"
#include "tests/benchmarks/hand_contact.hpp"
#include "tests/benchmarks/hand_edge_frames.hpp"
#include "tests/benchmarks/hand_nodes.hpp"

namespace bowstring::benchmarks {

namespace {

constexpr double tolerance = 1e-12;     // of the largest number of an array
constexpr double energy_factor = 0.75;  // of the Lagrangian: any number but 1
constexpr int mesh[2] = {80, 5000};

/// The kernel's own work.
class Kernel {
 public:
  explicit Kernel(BenchScene& bench) : bench_(bench), out_(*bench.assembly) {
    first_order_.energy = &out_.energy;
    first_order_.gradient = {out_.gradient.data(), out_.gradient.size() - 1};
    first_order_.rows = out_.rows;
    first_order_.jacobian = {out_.jacobian.data(), out_.jacobian.size() - 1};
    hessian_ = {out_.hessian.data(), out_.hessian.size() - 1};
  }

  void assemble(const std::vector<double>& q) {
    Status status = bench_.assembly->evaluate(q, first_order_);
    if (status.ok()) status = bench_.assembly->lagrangian_hessian(q, energy_factor, bench_.multipliers, hessian_);
    if (!status.ok()) throw std::runtime_error("the kernel does not evaluate: " + status.text);
  }
  const HandOutput& output() const { return out_; }

 private:
  BenchScene& bench_;
  HandOutput out_;
  ProblemEvaluation first_order_;
  Span<double> hessian_;
};

class Hand {
 public:
  virtual ~Hand() = default;
  virtual void assemble(const std::vector<double>& q) = 0;
  virtual const HandOutput& output() const = 0;
};

template <class Vessel, class Wire, int d>
class HandLoop final : public Hand {
 public:
  explicit HandLoop(const BenchScene& bench)
      : multipliers_(bench.multipliers.data()),
        positions_(*bench.assembly),
        vessel_(bench, bench.vessel(), positions_, rows_),
        wire_(bench, bench.wire(), positions_, rows_),
        anchoring_(bench, positions_),
        tension_(bench, positions_),
        contact_(bench, positions_, rows_),
        out_(*bench.assembly) {}

  void assemble(const std::vector<double>& q) override {
    out_.clear();
    vessel_.add(q.data(), energy_factor, multipliers_, out_);
    wire_.add(q.data(), energy_factor, multipliers_, out_);
    anchoring_.add(q.data(), energy_factor, out_);
    tension_.add(q.data(), out_);
    contact_.add(q.data(), multipliers_, out_);
  }
  const HandOutput& output() const override { return out_; }

 private:
  const double* multipliers_;
  Positions positions_;
  int rows_ = 0;
  Vessel vessel_;
  Wire wire_;
  HandAnchoring<d> anchoring_;
  HandTension tension_;
  HandContact<d> contact_;
  HandOutput out_;
};

std::unique_ptr<Hand> make_hand(const BenchScene& bench, const std::string& kinematics) {
  constexpr Manifold circle = Manifold::circle, direction = Manifold::direction, rotation = Manifold::rotation;
  const bool planar = bench.scene->dimension == 2;
  if (kinematics == "nodes") {
    if (planar) return std::make_unique<HandLoop<HandNodes<circle, false>, HandNodes<circle, true>, 2>>(bench);
    return std::make_unique<HandLoop<HandNodes<rotation, false>, HandNodes<direction, true>, 3>>(bench);
  }
  if (planar) return std::make_unique<HandLoop<HandEdgeFrames<circle, false>, HandEdgeFrames<circle, true>, 2>>(bench);
  return std::make_unique<HandLoop<HandEdgeFrames<rotation, false>, HandEdgeFrames<direction, true>, 3>>(bench);
}

double largest(const double* numbers, std::size_t count) {
  double out = 0.0;
  for (std::size_t i = 0; i < count; ++i) out = std::fmax(out, std::fabs(numbers[i]));
  return out;
}

void require_same(const char* what, const double* kernel, const double* hand, std::size_t count) {
  const double scale = largest(kernel, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::fabs(kernel[i] - hand[i]) <= tolerance * scale) continue;
    char text[160];
    std::snprintf(text, sizeof text, "%s %zu of %zu: the kernel has %.17g, the loop by hand %.17g (largest: %.3g)",
                  what, i, count, kernel[i], hand[i], scale);
    throw std::runtime_error(text);
  }
}

/// Throws where the two differ, or where a number that the terms should give is missing.
void require_same(const HandOutput& kernel, const HandOutput& hand, const Terms& terms) {
  const bool energies = terms.wire_bending || terms.vessel_strain || terms.anchoring || terms.axial_tension;
  if (energies && (kernel.energy == 0.0 || largest(kernel.gradient.data(), kernel.gradient.size() - 1) == 0.0)) {
    throw std::runtime_error("the energy or its gradient vanishes, so that nothing is compared");
  }
  if (largest(kernel.rows.data(), kernel.rows.size()) == 0.0 ||
      largest(kernel.hessian.data(), kernel.hessian.size()) == 0.0) {
    throw std::runtime_error("rows or Hessian vanish, so that nothing is compared");
  }
  require_same("energy", &kernel.energy, &hand.energy, 1);
  require_same("gradient", kernel.gradient.data(), hand.gradient.data(), kernel.gradient.size() - 1);
  require_same("row", kernel.rows.data(), hand.rows.data(), kernel.rows.size());
  require_same("Jacobian entry", kernel.jacobian.data(), hand.jacobian.data(), kernel.jacobian.size() - 1);
  require_same("Hessian entry", kernel.hessian.data(), hand.hessian.data(), kernel.hessian.size() - 1);
}

struct Part {
  const char* name;
  Terms terms;
};
/// The closure rows belong to every part: what a term costs is the difference.
constexpr Part parts[] = {
    {"all", all_terms},
    {"closure rows", {}},
    {"wire-bending", {.wire_bending = true}},
    {"vessel-strain", {.vessel_strain = true}},
    {"anchoring", {.anchoring = true}},
    {"axial-tension", {.axial_tension = true}},
    {"contact rows", {.contact = true}},
};

struct SceneName {
  const char* name;
  const char* file;
};
constexpr SceneName scenes[] = {{"planar", "planar-iliac-smooth.toml"}, {"helical", "helical-iliac-full.toml"}};
constexpr const char* kinematics_names[] = {"nodes", "edge-frames"};

std::string name_of(const char* who, const char* scene, const char* kinematics, int nodes, const char* part) {
  return std::string(who) + "/" + scene + "/" + kinematics + "/" + std::to_string(nodes) + "/" + part;
}

/// One scene with some of its terms, checked when it is made.
struct Pair {
  std::unique_ptr<BenchScene> bench;
  std::unique_ptr<Kernel> kernel;
  std::unique_ptr<Hand> hand;
  std::size_t next_of_kernel = 0, next_of_hand = 0;  // states
};

Pair make_pair(const SceneName& scene, const char* kinematics, int nodes, const Part& part) {
  Pair pair;
  pair.bench = make_bench_scene({scene.file, kinematics, nodes, part.terms});
  pair.kernel = std::make_unique<Kernel>(*pair.bench);
  pair.hand = make_hand(*pair.bench, kinematics);
  for (const std::vector<double>& state : pair.bench->state) {
    pair.kernel->assemble(state);
    pair.hand->assemble(state);
    try {
      require_same(pair.kernel->output(), pair.hand->output(), part.terms);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(name_of("scene", scene.name, kinematics, nodes, part.name) + ": " + error.what());
    }
  }
  return pair;
}

/// `k` goes on from run to run, so that no state is met twice in a row: the kernel would remember it.
template <class Assembler>
void time(benchmark::State& state, const BenchScene& bench, Assembler& assembler, std::size_t& k) {
  for (auto _ : state) {
    assembler.assemble(bench.state[k]);
    benchmark::DoNotOptimize(assembler.output().hessian.data());
    benchmark::ClobberMemory();
    k = 1 - k;
  }
}

/// Keeps the least time of each benchmark's repetitions: what else runs on the machine only adds.
class LeastTimes final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      const double seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
      auto [entry, added] = seconds_.emplace(run.run_name.function_name, seconds);
      if (!added) entry->second = std::fmin(entry->second, seconds);
    }
  }
  /// 0 for a benchmark that has not run.
  double nanoseconds(const std::string& name) const {
    const auto found = seconds_.find(name);
    return found == seconds_.end() ? 0.0 : 1e9 * found->second;
  }

 private:
  std::map<std::string, double> seconds_;
};

std::string ratio(double numerator, double denominator, double least) {
  if (!(numerator > least && denominator > least)) return "";
  char text[20];
  std::snprintf(text, sizeof text, "%.2f", numerator / denominator);
  return text;
}

void print_table(const LeastTimes& times) {
  constexpr double negligible = 0.5;  // ns per node, below which a difference of two times says nothing
  std::printf(
      "\nOne assembly, ns per node (of one curve). Kernel and hand: the term with the kinematics' closure rows; "
      "alone: without them, by difference.\n\n");
  std::printf(
      "| scene | kinematics | nodes | term | kernel | hand | ratio | alone: kernel | hand | ratio "
      "| 5000 to 80: kernel | hand |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  double worst = 0.0;
  for (const SceneName& scene : scenes) {
    for (const char* kinematics : kinematics_names) {
      for (const int nodes : mesh) {
        const auto per_node = [&](const char* who, int count, const char* part) {
          return times.nanoseconds(name_of(who, scene.name, kinematics, count, part)) / count;
        };
        const double base_kernel = per_node("kernel", nodes, parts[1].name);
        const double base_hand = per_node("hand", nodes, parts[1].name);
        for (const Part& part : parts) {
          const double kernel = per_node("kernel", nodes, part.name), hand = per_node("hand", nodes, part.name);
          if (kernel == 0.0 || hand == 0.0) continue;
          const bool term = &part > &parts[1] && base_hand > 0.0;
          const double alone_kernel = kernel - base_kernel, alone_hand = hand - base_hand;
          if (nodes == mesh[0]) worst = std::fmax(worst, kernel / hand);
          std::printf("| %s | %s | %d | %s | %.1f | %.1f | %.2f |", scene.name, kinematics, nodes, part.name, kernel,
                      hand, kernel / hand);
          if (term) {
            std::printf(" %.1f | %.1f | %s |", alone_kernel, alone_hand,
                        ratio(alone_kernel, alone_hand, negligible).c_str());
          } else {
            std::printf(" | | |");
          }
          const bool growth = nodes == mesh[1];
          std::printf(" %s | %s |\n", growth ? ratio(kernel, per_node("kernel", mesh[0], part.name), 0.0).c_str() : "",
                      growth ? ratio(hand, per_node("hand", mesh[0], part.name), 0.0).c_str() : "");
        }
      }
    }
  }
  std::printf("\nLargest ratio at %d nodes: %.2f\n", mesh[0], worst);
}

void register_pairs(std::list<Pair>& pairs, const std::string& only) {
  for (const SceneName& scene : scenes) {
    for (const char* kinematics : kinematics_names) {
      for (const int nodes : mesh) {
        for (const Part& part : parts) {
          if (name_of("", scene.name, kinematics, nodes, part.name).find(only) == std::string::npos) continue;
          pairs.push_back(make_pair(scene, kinematics, nodes, part));
          Pair& pair = pairs.back();
          benchmark::RegisterBenchmark(
              name_of("kernel", scene.name, kinematics, nodes, part.name).c_str(),
              [&pair](benchmark::State& state) { time(state, *pair.bench, *pair.kernel, pair.next_of_kernel); });
          benchmark::RegisterBenchmark(
              name_of("hand", scene.name, kinematics, nodes, part.name).c_str(),
              [&pair](benchmark::State& state) { time(state, *pair.bench, *pair.hand, pair.next_of_hand); });
        }
      }
    }
  }
}

}  // namespace

/// Every pair at the smaller mesh, without taking any time.
int compare() {
  for (const SceneName& scene : scenes) {
    for (const char* kinematics : kinematics_names) {
      for (const Part& part : parts) make_pair(scene, kinematics, mesh[0], part);
    }
  }
  return 0;
}

int run(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--compare") == 0) return compare();
  // The user's flags come after these, and win.
  std::vector<std::string> defaults{"--benchmark_repetitions=9", "--benchmark_enable_random_interleaving=true",
                                    "--benchmark_min_time=0.05"};
  std::string only;
  std::vector<char*> arguments{argv[0]};
  for (std::string& text : defaults) arguments.push_back(text.data());
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') {
      arguments.push_back(argv[i]);
    } else {
      only = argv[i];
    }
  }
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  std::list<Pair> pairs;
  register_pairs(pairs, only);
  LeastTimes times;
  benchmark::RunSpecifiedBenchmarks(&times);
  print_table(times);
  return 0;
}

}  // namespace bowstring::benchmarks

int main(int argc, char** argv) {
  try {
    return bowstring::benchmarks::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "assembly benchmark: %s\n", error.what());
    return 1;
  }
}
