#include "core/procedure/multistart.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "core/lie/s2.hpp"
#include "core/procedure/path_follower.hpp"
#include "core/procedure/summary.hpp"

namespace bowstring {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double pi = 3.14159265358979323846;
constexpr int most_waves = 4;            // sine waves of a perturbation
constexpr double length_share = 0.01;    // of the longest curve: a perturbation without contact
constexpr double clearance_share = 0.1;  // of the smallest clearance: a perturbation with contact
constexpr double wire_share = 0.3;       // of a perturbation: how a wire moves in its lumen
constexpr int most_pairs = 12;           // of minima between which a saddle is looked for
constexpr double saddle_places[] = {0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8};

/// Node positions of every curve of a state, one after the other.
using Shape = std::vector<std::vector<double>>;

/// A smooth displacement along a curve: sines that vanish at both ends, root mean square 1 over the arc.
class Wave {
 public:
  Wave(std::mt19937& random, int dimension) : dimension_(dimension) {
    std::normal_distribution<double> normal(0.0, 1.0);
    double square = 0.0;
    for (int w = 0; w < most_waves; ++w) {
      for (int k = 0; k < dimension; ++k) {
        amplitude_.push_back(normal(random) / (w + 1));
        square += 0.5 * amplitude_.back() * amplitude_.back();
      }
    }
    for (double& one : amplitude_) one /= std::sqrt(square);
  }

  /// `fraction` of the arc; component k.
  double operator()(double fraction, int k) const {
    double sum = 0.0;
    for (int w = 0; w < most_waves; ++w) sum += amplitude_[at(w * dimension_ + k)] * std::sin(pi * (w + 1) * fraction);
    return sum;
  }

 private:
  int dimension_;
  std::vector<double> amplitude_;
};

class Search {
 public:
  Search(Session& session, const MultistartTable& table, const std::function<bool(const IterationRecord&)>& progress,
         Solution& solution, std::vector<Equilibrium>& found)
      : session_(session), table_(table), progress_(progress), solution_(solution), found_(found) {}

  void run() {
    const std::vector<double> own = session_.start.q.empty() ? session_.scene->start_coordinates() : session_.start.q;
    // A walk has led to where no start leads.
    const std::vector<double>& first = session_.composition.continuation.given ? solution_.q : own;
    int lost = take(solution_, "start 1", true) ? 0 : 1;
    const double amplitude = table_.perturbation.value_or(default_perturbation());
    std::mt19937 random(static_cast<std::mt19937::result_type>(table_.seed));
    std::vector<Wave> waves;
    for (long k = 1; k < table_.starts && !stopped_; ++k) {
      const bool mirror = table_.mirrored && k % 2 == 0;
      if (!mirror) {
        waves.clear();
        for (std::size_t c = 0; c < session_.scene->curves.size(); ++c)
          waves.emplace_back(random, session_.scene->dimension);
      }
      const std::optional<std::vector<double>> q = perturbed(first, waves, mirror ? -amplitude : amplitude);
      if (!q || !try_start(*q, "start " + std::to_string(k + 1))) ++lost;
    }
    order();
    // Saddles are those of exact rows.
    const bool exact = session_.composition.enforcement.name == "kkt" || session_.assembly->summary().inequalities == 0;
    if (table_.saddles && exact && !stopped_) look_for_saddles();
    choose(lost);
  }

 private:
  double default_perturbation() const {
    double clearance = 0.0, longest = 0.0;
    for (const auto& curve : session_.scene->curves) longest = std::max(longest, curve->arc.back());
    for (int c = 0; c < static_cast<int>(session_.scene->constraints.size()); ++c) {
      std::vector<RowReport> rows;
      if (!session_.assembly->report(solution_.q, c, rows).ok()) continue;
      for (const RowReport& row : rows) {
        if (row.clearance > 0.0) clearance = clearance == 0.0 ? row.clearance : std::min(clearance, row.clearance);
      }
    }
    return clearance > 0.0 ? clearance_share * clearance : length_share * longest;
  }

  Span<const double> slice(const Curve& curve, const std::vector<double>& q) const {
    return {q.data() + curve.coordinate_begin, at(curve.coordinates)};
  }

  std::optional<Shape> shape_of(const std::vector<double>& q) const {
    Shape out;
    for (const auto& curve : session_.scene->curves) {
      std::vector<double> node;
      for (int i = 0; i < curve->view.nodes; ++i) node.push_back(i);
      CurveSample sample;
      if (!curve->kinematics->sample(slice(*curve, q), node, sample).ok()) return std::nullopt;
      out.push_back(std::move(sample.position));
    }
    return out;
  }

  /// The state q with its nodes at other places; frames follow their edges by parallel transport.
  std::optional<std::vector<double>> moved(const std::vector<double>& q, const Shape& shape) const {
    std::vector<double> out = q;
    for (std::size_t c = 0; c < shape.size(); ++c) {
      const Curve& curve = *session_.scene->curves[c];
      if (curve.view.rigid) continue;
      const int d = curve.view.dimension;
      std::vector<double> middle;
      for (int i = 0; i + 1 < curve.view.nodes; ++i) middle.push_back(i + 0.5);
      CurveSample sample;
      if (!curve.kinematics->sample(slice(curve, q), middle, sample).ok()) return std::nullopt;
      for (int i = 0; i + 1 < curve.view.nodes; ++i) {
        Vector3 edge;
        for (int k = 0; k < d; ++k) edge[k] = shape[c][at((i + 1) * d + k)] - shape[c][at(i * d + k)];
        const double length = std::sqrt(dot(edge, edge));
        if (!(length > 0.0)) return std::nullopt;
        const lie::Rotation turned =
            lie::transport(lie::Rotation::load(sample.orientation.data() + 4 * i), (1.0 / length) * edge);
        turned.store(sample.orientation.data() + 4 * i);
      }
      const CurveShape wanted{shape[c], sample.orientation};
      if (!curve.kinematics->adopt(wanted, {out.data() + curve.coordinate_begin, at(curve.coordinates)}).ok()) {
        return std::nullopt;
      }
    }
    hold_ends(*session_.scene, out);
    return out;
  }

  /// Wires move with the vessel that they lie along, and a little in it.
  std::optional<std::vector<double>> perturbed(const std::vector<double>& q, const std::vector<Wave>& waves,
                                               double amplitude) const {
    std::optional<Shape> shape = shape_of(q);
    if (!shape) return std::nullopt;
    for (std::size_t c = 0; c < shape->size(); ++c) {
      const Curve& curve = *session_.scene->curves[c];
      if (curve.view.rigid) continue;
      const int d = curve.view.dimension;
      const Curve* vessel = curve.along >= 0 ? session_.scene->curves[at(curve.along)].get() : nullptr;
      const bool carried = vessel != nullptr && !vessel->view.rigid;
      for (int i = 0; i < curve.view.nodes; ++i) {
        const double own = curve.arc[at(i)] / curve.arc.back();
        const double along =
            carried ? (curve.along_begin + own * (curve.along_end - curve.along_begin)) / vessel->arc.back() : 0.0;
        for (int k = 0; k < d; ++k) {
          const double free = (carried ? wire_share : 1.0) * waves[c](own, k);
          (*shape)[c][at(i * d + k)] += amplitude * (free + (carried ? waves[at(curve.along)](along, k) : 0.0));
        }
      }
    }
    return moved(q, *shape);
  }

  bool try_start(const std::vector<double>& q, const std::string& origin) {
    Start start;
    start.q = q;
    start.only = true;
    const auto watched = [&](const IterationRecord& record) {
      stopped_ = stopped_ || (progress_ && !progress_(record));
      return !stopped_;
    };
    const Solution solution = solve(session_, watched, &start);
    return take(solution, origin, true);
  }

  /// Adds an equilibrium, or counts it to the one that it is. False where the solution is none.
  bool take(const Solution& solution, const std::string& origin, bool counts) {
    if (solution.certificate.verdict != Verdict::converged) return false;
    std::optional<Shape> shape = shape_of(solution.q);
    if (!shape) return false;
    for (std::size_t e = 0; e < found_.size(); ++e) {
      if (largest_distance(*shape, shapes_[e]) > table_.distance) continue;
      found_[e].basin += counts ? 1 : 0;
      return true;
    }
    Equilibrium one;
    one.origin = origin;
    one.basin = counts ? 1 : 0;
    one.q = solution.q;
    one.multipliers = solution.multipliers;
    one.state = summarise(session_, solution);
    found_.push_back(std::move(one));
    shapes_.push_back(std::move(*shape));
    solutions_.push_back(solution);
    return true;
  }

  double largest_distance(const Shape& a, const Shape& b) const {
    double largest = 0.0;
    const int d = session_.scene->dimension;
    for (std::size_t c = 0; c < a.size(); ++c) {
      for (std::size_t i = 0; i < a[c].size(); i += at(d)) {
        double square = 0.0;
        for (std::size_t k = i; k < i + at(d); ++k) square += (a[c][k] - b[c][k]) * (a[c][k] - b[c][k]);
        largest = std::max(largest, square);
      }
    }
    return std::sqrt(largest);
  }

  void order() {
    std::vector<std::size_t> rank(found_.size());
    for (std::size_t e = 0; e < rank.size(); ++e) rank[e] = e;
    std::stable_sort(rank.begin(), rank.end(), [&](std::size_t a, std::size_t b) {
      return total_energy(found_[a].state) < total_energy(found_[b].state);
    });
    std::vector<Equilibrium> found;
    std::vector<Shape> shapes;
    std::vector<Solution> solutions;
    for (const std::size_t e : rank) {
      found.push_back(std::move(found_[e]));
      shapes.push_back(std::move(shapes_[e]));
      solutions.push_back(std::move(solutions_[e]));
    }
    found_ = std::move(found);
    shapes_ = std::move(shapes);
    solutions_ = std::move(solutions);
  }

  bool is_minimum(std::size_t e) const {
    return found_[e].state.certificate.second_order.curvature == Curvature::minimum;
  }

  /// Each minimum with the nearest other one, once.
  std::vector<std::pair<std::size_t, std::size_t>> neighbours() const {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t a = 0; a < found_.size(); ++a) {
      std::size_t nearest = a;
      for (std::size_t b = 0; b < found_.size(); ++b) {
        if (a == b || !is_minimum(a) || !is_minimum(b)) continue;
        if (nearest == a || largest_distance(shapes_[a], shapes_[b]) < largest_distance(shapes_[a], shapes_[nearest])) {
          nearest = b;
        }
      }
      const std::pair<std::size_t, std::size_t> pair(std::min(a, nearest), std::max(a, nearest));
      if (nearest != a && std::find(out.begin(), out.end(), pair) == out.end()) out.push_back(pair);
    }
    if (out.size() > at(most_pairs)) out.resize(at(most_pairs));
    return out;
  }

  void look_for_saddles() {
    const auto pairs = neighbours();
    for (const auto& [a, b] : pairs) {
      if (!find_saddle(a, b)) {
        told_.push_back("no saddle was found between equilibria " + std::to_string(a + 1) + " and " +
                        std::to_string(b + 1));
      }
    }
  }

  /// Newton's method on the first-order conditions, which does not descend, from places on the straight way between two
  /// minima.
  bool find_saddle(std::size_t a, std::size_t b) {
    const std::string origin = "between equilibria " + std::to_string(a + 1) + " and " + std::to_string(b + 1);
    for (const double place : saddle_places) {
      Shape shape = shapes_[a];
      for (std::size_t c = 0; c < shape.size(); ++c) {
        for (std::size_t i = 0; i < shape[c].size(); ++i) shape[c][i] += place * (shapes_[b][c][i] - shape[c][i]);
      }
      const std::optional<std::vector<double>> q = moved(found_[a].q, shape);
      if (!q) continue;
      PathState state;
      state.q = *q;
      for (std::size_t r = 0; r < found_[a].multipliers.size(); ++r) {
        state.multipliers.push_back((1.0 - place) * found_[a].multipliers[r] + place * found_[b].multipliers[r]);
      }
      ParameterFamily family(session_);
      PathFollower follower(family);
      if (!follower.settle_without_direction(state).ok()) continue;
      SolverResult found;
      found.claim = Claim::optimal;
      found.reason = "found by Newton's method " + origin;
      found.q = state.q;
      found.multipliers = state.multipliers;
      found.iterations = state.iterations;
      const Solution solution = certified(session_, std::move(found));
      if (solution.certificate.second_order.curvature != Curvature::saddle) continue;
      take(solution, origin, false);
      return true;
    }
    return false;
  }

  void choose(int lost) {
    order();
    std::size_t lowest = found_.size();
    for (std::size_t e = found_.size(); e-- > 0;) {
      if (is_minimum(e)) lowest = e;
    }
    if (lowest == found_.size() && !found_.empty()) lowest = 0;
    if (lost > 0) {
      told_.push_back(std::to_string(lost) + " of " + std::to_string(table_.starts) +
                      " starts of [multistart] led to no equilibrium");
    }
    if (!table_.seed_given) told_.push_back("[multistart] has no seed; 1 was taken");
    if (lowest < found_.size()) {
      solution_ = solutions_[lowest];
      bind_anew(session_, solution_.q);
      session_.assembly->accept(solution_.q);
    }
    solution_.warnings.insert(solution_.warnings.end(), told_.begin(), told_.end());
  }

  Session& session_;
  const MultistartTable& table_;
  const std::function<bool(const IterationRecord&)>& progress_;
  Solution& solution_;
  std::vector<Equilibrium>& found_;
  std::vector<Shape> shapes_;
  std::vector<Solution> solutions_;
  std::vector<std::string> told_;
  bool stopped_ = false;
};

}  // namespace

void find_equilibria(Session& session, const MultistartTable& table,
                     const std::function<bool(const IterationRecord&)>& progress, Solution& solution,
                     std::vector<Equilibrium>& equilibria) {
  Search(session, table, progress, solution, equilibria).run();
}

}  // namespace bowstring
