#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "core/lie/curve_frames.hpp"
#include "core/transport/transport_comparison.hpp"
#include "plugins/host/plugin_host.hpp"

// Ground costs on frames, and exact transport under them: microseconds per pair, milliseconds per transport, and the
// share of pairs that a dear cost is evaluated for.

namespace {

using namespace bowstring;
using Clock = std::chrono::steady_clock;

/// A coil of `count` Bishop frames, bent and moved by `change`.
Measure coil(int count, double length, double change) {
  std::vector<double> points;
  for (int i = 0; i <= count; ++i) {
    const double s = static_cast<double>(i) / count, angle = 5.0 * s + change * s * s;
    points.insert(points.end(), {0.15 * length * std::cos(angle) + 0.02 * length * change,
                                 0.15 * length * std::sin(angle + 0.3 * change), 0.6 * length * s});
  }
  Measure out;
  for (const lie::Rotation& r : lie::bishop_edge_frames(points)) {
    const auto i = out.weight.size();
    for (std::size_t k = 0; k < 3; ++k) out.position.push_back(0.5 * (points[3 * i + k] + points[3 * i + 3 + k]));
    out.orientation.insert(out.orientation.end(), {r.w, r.x, r.y, r.z});
    out.weight.push_back(1.0 / count);
  }
  return out;
}

struct Study {
  const char* cost;
  std::vector<Override> settings;
};

double milliseconds(Clock::time_point start) {
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

bool run(const Study& study, PluginHost& plugins, const Measure& a, const Measure& b, const char* where) {
  Refusal refusal;
  std::optional<TransportComparison> transport =
      TransportComparison::open({"exact", study.cost, study.settings}, plugins, refusal);
  if (!transport) {
    std::fprintf(stderr, "%s\n", refusal.text().c_str());
    return false;
  }
  const GroundCost& cost = transport->ground_cost();
  const int rows = static_cast<int>(a.count());
  const std::size_t pairs = a.count() * b.count();
  std::vector<double> matrix(pairs), lower(pairs);
  Clock::time_point start = Clock::now();
  Status status = cost.rows(a, b, 0, rows, matrix);
  const double for_matrix = milliseconds(start);
  double tightness = 1.0;
  if (status.ok() && cost.dear()) {
    status = cost.lower_bounds(a, b, 0, rows, lower);
    tightness = 0.0;
    for (std::size_t k = 0; k < pairs; ++k) tightness += lower[k] / matrix[k] / static_cast<double>(pairs);
  }
  TransportResult lazy, full;
  start = Clock::now();
  if (status.ok()) status = transport->compare(a, b, lazy, false);
  const double for_transport = milliseconds(start);
  if (status.ok()) {
    transport->forget();
    status = transport->compare(a.weight, b.weight, matrix, full);
  }
  if (!status.ok()) {
    std::fprintf(stderr, "%s: %s\n", study.cost, status.text.c_str());
    return false;
  }
  const auto count = static_cast<double>(pairs);
  std::printf("| %s | %s | %.2f | %.1f | %.1f | %.1f | %.12g | %.1e |\n", study.cost, where, 1e3 * for_matrix / count,
              for_transport, 100.0 * static_cast<double>(lazy.costs_evaluated) / count, 100.0 * tightness,
              lazy.answer.value, std::fabs(lazy.answer.value - full.answer.value) / full.answer.value);
  return std::fabs(lazy.answer.value - full.answer.value) <= 1e-10 * full.answer.value;
}

}  // namespace

int main() {
  PluginHost plugins;
  const std::vector<Override> slow{{"forward-weight", "\"0.05 1/mm\"", "", ""}};
  const std::vector<Override> unit{};
  std::vector<Override> lateral = slow;
  lateral.push_back({"lateral-weight", "\"0.5 1/mm\"", "", ""});
  const std::vector<Study> studies{{"euclidean", {}},           {"se3-nilpotent", slow},
                                   {"se3-nilpotent", unit},     {"se3-subriemannian", slow},
                                   {"se3-subriemannian", unit}, {"se3-riemannian", lateral}};
  std::puts(
      "| cost | forward-weight, change of the coil | us per pair | transport, ms | evaluated, % | bound of cost, % | "
      "W2^2 | "
      "off |");
  std::puts("|---|---|---|---|---|---|---|---|");
  bool held = true;
  for (const double change : {0.1, 0.5}) {
    const Measure a = coil(100, 300.0, 0.0), b = coil(100, 300.0, change);
    for (const Study& study : studies) {
      const std::string where =
          std::string(study.settings.empty() ? "1/mm" : "0.05 1/mm") + ", change " + std::to_string(change);
      held = run(study, plugins, a, b, where.c_str()) && held;
    }
  }
  return held ? 0 : 1;
}
