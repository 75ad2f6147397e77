#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>

#include "core/interfaces/transport.hpp"
#include "losses/transport/sliced/directions.hpp"
#include "losses/transport/sliced/line_transport.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::sliced;

const ParameterDeclaration schema[] = {
    {"directions", ParameterType::integer, "", "60",
     "lines that the points are projected on; a multiple of 3 is exact for shifts", 1, 1e6},
    {"seed", ParameterType::integer, "", "1", "which lines: the same for the same seed", 0, 1e9},
};

/// The mean over lines of the squared distance between the projections of two measures (J. Rabin et al., "Wasserstein
/// barycenter and its application to texture mixing", SSVM (2011)): a shift by t has |t|²/3.
class Sliced final : public Transport {
 public:
  explicit Sliced(const ParameterSet& parameters)
      : directions_(directions(static_cast<int>(parameters.integer("directions")), parameters.integer("seed"))) {}

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    return guard([&]() -> Status {
      out = {};
      if (problem.a == nullptr || problem.b == nullptr || std::strcmp(problem.ground_cost, "euclidean") != 0) {
        const std::string given = *problem.ground_cost != '\0'
                                      ? "ground cost '" + std::string(problem.ground_cost) + "'"
                                      : std::string("a matrix of costs");
        return Status::failure(Code::unsupported,
                               "transport 'sliced' projects points on lines, and was given " + given +
                                   "; expected two measures with ground cost 'euclidean'; choose it, or "
                                   "transport 'exact'");
      }
      compare(problem, out);
      return {};
    });
  }

 private:
  /// Adds what one line says to the sums.
  void add_line(const Vector3& direction, const TransportProblem& problem, const std::vector<double>& weight_b,
                TransportAnswer& out) {
    const LineMeasure a = sorted(projected(*problem.a, direction), problem.weight_a);
    const LineMeasure b = sorted(projected(*problem.b, direction), weight_b);
    const std::vector<LineStep> steps = staircase(a, b);
    const double share = 1.0 / static_cast<double>(directions_.size());
    for (const LineStep& step : steps) {
      if (step.mass <= 0.0) continue;
      const auto i = static_cast<std::size_t>(a.place[step.i]), j = static_cast<std::size_t>(b.place[step.j]);
      const double mass = share * step.mass, apart = a.position[step.i] - b.position[step.j];
      out.value += mass * apart * apart;
      for (int e = 0; e < 3; ++e) {
        out.position_gradient_a[3 * i + static_cast<std::size_t>(e)] += 2.0 * mass * apart * direction[e];
        out.position_gradient_b[3 * j + static_cast<std::size_t>(e)] -= 2.0 * mass * apart * direction[e];
      }
      out.plan.row.push_back(a.place[step.i]);
      out.plan.column.push_back(b.place[step.j]);
      out.plan.value.push_back(mass);
    }
    staircase_potentials(a, b, steps, line_u_, line_v_);
    for (std::size_t i = 0; i < line_u_.size(); ++i) out.dual_a[i] += share * line_u_[i];
    for (std::size_t j = 0; j < line_v_.size(); ++j) out.dual_b[j] += share * line_v_[j];
  }

  void compare(const TransportProblem& problem, TransportAnswer& out) {
    const std::size_t rows = problem.weight_a.size(), columns = problem.weight_b.size();
    out.dual_a.assign(rows, 0.0);
    out.dual_b.assign(columns, 0.0);
    out.position_gradient_a.assign(3 * rows, 0.0);
    out.position_gradient_b.assign(3 * columns, 0.0);
    const std::vector<double> weight_b = of_equal_sum(problem.weight_a, problem.weight_b);
    for (const Vector3& direction : directions_) add_line(direction, problem, weight_b, out);
    out.memory_bytes =
        out.plan.value.size() * (2 * sizeof(int) + sizeof(double)) + 8 * sizeof(double) * (rows + columns);
    merge(out.plan);
    center(problem.weight_a, weight_b, out);
    out.weight_gradient_a = out.dual_a;
    out.weight_gradient_b = out.dual_b;
    for (std::size_t k = 0; k < out.plan.value.size(); ++k) {
      out.transport_cost += out.plan.value[k] * squared_distance(problem, out.plan.row[k], out.plan.column[k]);
    }
    out.iterations = static_cast<long>(directions_.size());
  }

  static std::vector<double> projected(const Measure& measure, const Vector3& direction) {
    std::vector<double> out(measure.count());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = dot(Vector3::load(&measure.position[3 * i]), direction);
    return out;
  }

  static std::vector<double> of_equal_sum(Span<const double> a, Span<const double> b) {
    const double sum_a = std::accumulate(a.begin(), a.end(), 0.0), sum_b = std::accumulate(b.begin(), b.end(), 0.0);
    std::vector<double> out(b.begin(), b.end());
    for (double& weight : out) weight *= sum_a / sum_b;
    return out;
  }

  static double squared_distance(const TransportProblem& problem, int i, int j) {
    return norm_squared(Vector3::load(problem.a->position.data() + 3 * i) -
                        Vector3::load(problem.b->position.data() + 3 * j));
  }

  /// One entry for each pair, in the order of rows and columns.
  static void merge(SparseEntries& plan) {
    std::vector<std::size_t> order(plan.value.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t k, std::size_t l) {
      return plan.row[k] != plan.row[l] ? plan.row[k] < plan.row[l] : plan.column[k] < plan.column[l];
    });
    SparseEntries out;
    for (const std::size_t k : order) {
      if (!out.row.empty() && out.row.back() == plan.row[k] && out.column.back() == plan.column[k]) {
        out.value.back() += plan.value[k];
        continue;
      }
      out.row.push_back(plan.row[k]);
      out.column.push_back(plan.column[k]);
      out.value.push_back(plan.value[k]);
    }
    plan = std::move(out);
  }

  /// Moves a constant between the potentials so that Σ a u = Σ b v.
  static void center(Span<const double> a, Span<const double> b, TransportAnswer& out) {
    double of_a = 0.0, of_b = 0.0, mass = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      of_a += a[i] * out.dual_a[i];
      mass += a[i];
    }
    for (std::size_t j = 0; j < b.size(); ++j) of_b += b[j] * out.dual_b[j];
    out.gap = out.value - of_a - of_b;
    const double shift = 0.5 * (of_b - of_a) / mass;
    for (double& u : out.dual_a) u += shift;
    for (double& v : out.dual_b) v -= shift;
  }

  std::vector<Vector3> directions_;
  std::vector<double> line_u_, line_v_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, Sliced>(
    bowstring::Kind::transport, "sliced", "Mean over lines of the squared distance between projections; of points",
    schema))
