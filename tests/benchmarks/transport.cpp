// Makes transport problems, and solves them with a method of this build.
//
//   benchmark-transport make KIND COUNT SEED NUMBER FILE    cloud, weighted-cloud, curve; walk-cloud, walk-curve
//   benchmark-transport solve METHOD FILE REPEATS           every problem cold
//   benchmark-transport walk METHOD FILE REPEATS            the problems one after the other, what is kept is kept
//   benchmark-transport memory METHOD FILE                  growth of the process in one solve
//   benchmark-transport points METHOD COUNT                 the same from points, without a matrix

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "core/transport/check_measure.hpp"
#include "core/transport/transport_comparison.hpp"
#include "plugins/host/plugin_host.hpp"
#include "transport_problems.hpp"

using namespace bowstring;
using namespace bench;

namespace {

using Points = std::vector<double>;

double uniform(std::mt19937& random) { return (static_cast<double>(random()) + 0.5) / 4294967296.0; }

double normal(std::mt19937& random) {
  return std::sqrt(-2.0 * std::log(uniform(random))) * std::cos(2.0 * std::acos(-1.0) * uniform(random));
}

Points cloud(std::mt19937& random, int count) {
  Points out(static_cast<std::size_t>(3 * count));
  for (double& x : out) x = normal(random);
  return out;
}

/// A coil of random turns, phase and tilt, in order of its arc.
Points curve(std::mt19937& random, int count) {
  const double turns = 3.0 + 3.0 * uniform(random), phase = 6.0 * uniform(random), tilt = 0.3 * normal(random);
  Points out;
  for (int i = 0; i < count; ++i) {
    const double t = (i + 0.5) / count, angle = 2.0 * std::acos(-1.0) * turns * t + phase;
    const double x = 30.0 * std::cos(angle), y = 30.0 * std::sin(angle), z = 20.0 * t + 5.0 * std::sin(7.0 * t + phase);
    out.insert(out.end(), {x, y * std::cos(tilt) - z * std::sin(tilt), y * std::sin(tilt) + z * std::cos(tilt)});
  }
  return out;
}

double squared_distance(const double* p, const double* q) {
  return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]);
}

std::vector<double> costs(const Points& a, const Points& b) {
  std::vector<double> out;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    for (std::size_t j = 0; j < b.size(); j += 3) out.push_back(squared_distance(&a[i], &b[j]));
  }
  return out;
}

/// Mean distance of a point to the nearest other one.
double spacing(const Points& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    double nearest = HUGE_VAL;
    for (std::size_t j = 0; j < points.size(); j += 3) {
      if (i != j) nearest = std::min(nearest, squared_distance(&points[i], &points[j]));
    }
    sum += std::sqrt(nearest);
  }
  return sum / (static_cast<double>(points.size()) / 3.0);
}

/// Every point by `length`, each its own way.
void step(std::mt19937& random, Points& points, double length) {
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double way[] = {normal(random), normal(random), normal(random)};
    const double norm = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    for (std::size_t e = 0; e < 3; ++e) points[i + e] += length * way[e] / norm;
  }
}

std::vector<double> random_weights(std::mt19937& random, int count) {
  std::vector<double> out(static_cast<std::size_t>(count));
  for (double& weight : out) weight = uniform(random);
  const double sum = std::accumulate(out.begin(), out.end(), 0.0);
  for (double& weight : out) weight /= sum;
  return out;
}

Problems make(const std::string& kind, int count, unsigned seed, int number) {
  std::mt19937 random(seed);
  const bool curves = kind.find("curve") != std::string::npos, walk = kind.rfind("walk", 0) == 0;
  const bool weighted = kind.rfind("weighted", 0) == 0;
  const auto points = curves ? curve : cloud;
  Problems out;
  out.rows = out.columns = count;
  out.weight_a = weighted ? random_weights(random, count) : uniform_weights(static_cast<std::size_t>(count));
  out.weight_b = weighted ? random_weights(random, count) : uniform_weights(static_cast<std::size_t>(count));
  Points a = points(random, count), b = points(random, count);
  const double length = 0.1 * spacing(a);
  for (int k = 0; k < number; ++k) {
    out.cost.push_back(costs(a, b));
    if (walk) {
      step(random, a, length);
    } else {
      a = points(random, count);
      b = points(random, count);
    }
  }
  return out;
}

TransportComparison open(const std::string& method) {
  static PluginHost plugins;
  Refusal refusal;
  std::optional<TransportComparison> out = TransportComparison::open({method, "euclidean", {}}, plugins, refusal);
  if (out) return *std::move(out);
  std::fprintf(stderr, "%s\n", refusal.text().c_str());
  std::exit(1);
}

void require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s\n", status.text.c_str());
  std::exit(1);
}

/// All that a comparison gives, its proof included, in seconds.
void solve(const std::string& method, const Problems& problems, int repeats, bool walk) {
  TransportComparison comparison = open(method);
  std::vector<double> seconds, value, pivots, cost;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t k = 0; k < problems.cost.size(); ++k) {
      if (!walk || k == 0) comparison.forget();
      TransportResult result;
      cost = problems.cost[k];  // as if it had just been computed
      const double start = seconds_now();
      require(comparison.compare(problems.weight_a, problems.weight_b, cost, result));
      // The first of a walk is a cold one.
      if (!walk || k > 0) seconds.push_back(seconds_now() - start);
      if (repeat > 0) continue;
      value.push_back(result.answer.value);
      pivots.push_back(static_cast<double>(result.answer.iterations));
    }
  }
  std::printf("{");
  print_numbers("seconds", seconds, ", ");
  print_numbers("value", value, ", ");
  print_numbers("pivots", pivots, "}\n");
}

/// What the kernel counts for this process, in bytes.
double resident(const char* what) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(what, 0) == 0) return 1024.0 * std::strtod(line.c_str() + std::strlen(what), nullptr);
  }
  return std::nan("");
}

void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

void print_growth(double before, const TransportResult& result) {
  std::printf("{\"growth\": %.0f, \"claimed\": %.0f, \"value\": %.17g}\n", resident("VmHWM:") - before,
              static_cast<double>(result.answer.memory_bytes), result.answer.value);
}

void memory(const std::string& method, const std::string& file) {
  TransportComparison comparison = open(method);
  const Problems problems = read_problems(file);
  TransportResult result;
  forget_peak();
  const double before = resident("VmRSS:");
  require(comparison.compare(problems.weight_a, problems.weight_b, problems.cost.front(), result));
  print_growth(before, result);
}

void memory_from_points(const std::string& method, int count) {
  TransportComparison comparison = open(method);
  std::mt19937 random(1);
  const std::vector<double> weight = uniform_weights(static_cast<std::size_t>(count));
  const Measure a{cloud(random, count), {}, weight}, b{cloud(random, count), {}, weight};
  TransportResult result;
  forget_peak();
  const double before = resident("VmRSS:");
  require(comparison.compare(a, b, result));
  print_growth(before, result);
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> word(words + 1, words + count);
  const std::string verb = word.empty() ? "" : word[0];
  if (verb == "make" && word.size() == 6) {
    write_problems(make(word[1], std::stoi(word[2]), static_cast<unsigned>(std::stoul(word[3])), std::stoi(word[4])),
                   word[5]);
  } else if ((verb == "solve" || verb == "walk") && word.size() == 4) {
    solve(word[1], read_problems(word[2]), std::stoi(word[3]), verb == "walk");
  } else if (verb == "memory" && word.size() == 3) {
    memory(word[1], word[2]);
  } else if (verb == "points" && word.size() == 3) {
    memory_from_points(word[1], std::stoi(word[2]));
  } else {
    std::fprintf(stderr,
                 "make KIND COUNT SEED NUMBER FILE | solve METHOD FILE REPEATS | walk METHOD FILE REPEATS | "
                 "memory METHOD FILE | points METHOD COUNT\n");
    return 2;
  }
  return 0;
}
