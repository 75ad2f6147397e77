#include "losses/transport/fused-gromov-wasserstein/conditional_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "plugins/sdk/guard.hpp"

namespace bowstring::gromov {
namespace {

struct Entry {
  Eigen::Index row, column;
  double mass;

  friend bool operator==(const Entry&, const Entry&) = default;
};

std::vector<Entry> entries_of(const Matrix& plan) {
  std::vector<Entry> out;
  for (Eigen::Index i = 0; i < plan.rows(); ++i) {
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      if (plan(i, j) > 0.0) out.push_back({i, j, plan(i, j)});
    }
  }
  return out;
}

double linear_part(const Problem& problem, const Matrix& plan) {
  return problem.alpha < 1.0 ? (1.0 - problem.alpha) * problem.cost.cwiseProduct(plan).sum() : 0.0;
}

/// Σ_k A_ik² a_k.
Vector second_moment(const Matrix& structure, const Vector& weight) {
  return (structure.cwiseAbs2() * weight.matrix()).array();
}

/// F's parts that do not change with the plan, and its gradient.
class Gradient {
 public:
  explicit Gradient(const Problem& problem)
      : problem_(problem),
        moment_a_(second_moment(problem.structure_a, problem.a)),
        moment_b_(second_moment(problem.structure_b, problem.b)) {}

  /// `crossed`: A γ B.
  Matrix operator()(const Matrix& crossed) const {
    Matrix out = -4.0 * problem_.alpha * crossed;
    out.array().colwise() += 2.0 * problem_.alpha * moment_a_;
    out.array().rowwise() += 2.0 * problem_.alpha * moment_b_.transpose();
    if (problem_.alpha < 1.0) out += (1.0 - problem_.alpha) * problem_.cost;
    return out;
  }
  double value(const Matrix& plan, const Matrix& crossed) const {
    const double apart = (problem_.a * moment_a_).sum() + (problem_.b * moment_b_).sum();
    return linear_part(problem_, plan) + problem_.alpha * (apart - 2.0 * crossed.cwiseProduct(plan).sum());
  }

 private:
  const Problem& problem_;
  Vector moment_a_, moment_b_;
};

/// Where linear τ + quadratic τ² is least in [0, most].
double best_step(double linear, double quadratic, double most) {
  if (quadratic > 0.0) return std::clamp(-linear / (2.0 * quadratic), 0.0, most);
  return linear + quadratic * most < 0.0 ? most : 0.0;
}

/// A plan as shares of others, the start and vertices.
class Mixture {
 public:
  explicit Mixture(const Matrix& plan) : plan_(plan), atoms_{{entries_of(plan), 1.0}} {}

  const Matrix& plan() const noexcept { return plan_; }
  double share(std::size_t k) const { return atoms_[k].share; }
  Matrix atom(std::size_t k) const {
    Matrix out = Matrix::Zero(plan_.rows(), plan_.cols());
    add(atoms_[k], 1.0, out);
    return out;
  }

  /// The one that costs most.
  std::size_t worst(const Matrix& cost) const {
    std::size_t out = 0;
    double most = -HUGE_VAL;
    for (std::size_t k = 0; k < atoms_.size(); ++k) {
      double sum = 0.0;
      for (const Entry& entry : atoms_[k].entries) sum += entry.mass * cost(entry.row, entry.column);
      if (sum > most) {
        most = sum;
        out = k;
      }
    }
    return out;
  }

  /// Some of the share of one goes to `vertex`.
  void exchange(std::size_t from, const Matrix& vertex, double share) {
    add(atoms_[from], -share, plan_);
    Atom to{entries_of(vertex), share};
    add(to, share, plan_);
    const bool all = share >= atoms_[from].share;
    atoms_[from].share -= share;
    const auto known =
        std::find_if(atoms_.begin(), atoms_.end(), [&to](const Atom& atom) { return atom.entries == to.entries; });
    if (known == atoms_.end()) {
      atoms_.push_back(std::move(to));
    } else {
      known->share += share;
    }
    if (all) atoms_.erase(atoms_.begin() + static_cast<std::ptrdiff_t>(from));
  }

  /// The plan anew, with zeros where none of them has mass.
  Matrix summed() const {
    Matrix out = Matrix::Zero(plan_.rows(), plan_.cols());
    for (const Atom& atom : atoms_) add(atom, atom.share, out);
    return out;
  }

  std::size_t memory_bytes() const {
    std::size_t out = 0;
    for (const Atom& atom : atoms_) out += atom.entries.capacity() * sizeof(Entry);
    return out;
  }

 private:
  struct Atom {
    std::vector<Entry> entries;
    double share;
  };

  static void add(const Atom& atom, double factor, Matrix& out) {
    for (const Entry& entry : atom.entries) out(entry.row, entry.column) += factor * entry.mass;
  }

  Matrix plan_;
  std::vector<Atom> atoms_;
};

[[noreturn]] void refuse(double gap, double scale, const Settings& settings) {
  char text[256];
  std::snprintf(text, sizeof text,
                "after %ld steps the Frank-Wolfe gap is %.3g of what a plan may cost; expected %.3g; raise "
                "max-iterations or tolerance",
                settings.max_iterations, gap / scale, settings.tolerance);
  throw StatusError(Code::failed, text);
}

}  // namespace

double scale_of(const Problem& problem) {
  const Gradient gradient(problem);
  const Matrix product = problem.a.matrix() * problem.b.matrix().transpose() / problem.b.sum();
  const double scale = linear_part(problem, product.cwiseAbs()) +
                       problem.alpha * ((problem.a * second_moment(problem.structure_a, problem.a)).sum() +
                                        (problem.b * second_moment(problem.structure_b, problem.b)).sum());
  return scale > 0.0 ? scale : 1.0;
}

/// Pair by pair where the plan is thin: then nothing cancels, and a plan that keeps all distances costs nothing.
double value_of(const Problem& problem, const Matrix& plan) {
  const std::vector<Entry> entries = entries_of(plan);
  if (entries.size() > static_cast<std::size_t>(8 * (plan.rows() + plan.cols()))) {
    return Gradient(problem).value(plan, problem.structure_a * plan * problem.structure_b);
  }
  double sum = 0.0;
  for (const Entry& one : entries) {
    for (const Entry& other : entries) {
      const double apart = problem.structure_a(one.row, other.row) - problem.structure_b(one.column, other.column);
      sum += one.mass * other.mass * apart * apart;
    }
  }
  return linear_part(problem, plan) + problem.alpha * sum;
}

Matrix vertex_of(const simplex::NetworkSimplex& simplex) {
  const simplex::Masses& masses = simplex.masses();
  Matrix out =
      Matrix::Zero(static_cast<Eigen::Index>(masses.supply.size()), static_cast<Eigen::Index>(masses.demand.size()));
  for (const simplex::Arc& arc : simplex.plan()) {
    out(arc.row, arc.column) = static_cast<double>(arc.mass) * masses.quantum;
  }
  return out;
}

Stationary descend(const Problem& problem, const Matrix& start, const Settings& settings,
                   simplex::NetworkSimplex& simplex) {
  constexpr double rounding = 1e-14;
  const Gradient gradient(problem);
  const double scale = scale_of(problem);
  const auto crossed_of = [&problem](const Matrix& plan) -> Matrix {
    return problem.structure_a * plan * problem.structure_b;
  };
  const auto curvature = [&problem](const Matrix& change, const Matrix& crossed) {
    return -2.0 * problem.alpha * crossed.cwiseProduct(change).sum();
  };
  Stationary out;
  Mixture mixture(start);
  Matrix crossed = crossed_of(start);
  for (;; ++out.iterations) {
    const Matrix slope = gradient(crossed);
    if (!simplex.solve(slope.data())) throw StatusError(Code::failed, "a linear program of the method has no plan");
    out.pivots += simplex.pivots();
    const Matrix vertex = vertex_of(simplex), vertex_crossed = crossed_of(vertex), change = vertex - mixture.plan();
    const double linear = slope.cwiseProduct(change).sum();
    const double quadratic = curvature(change, vertex_crossed - crossed);
    out.gap = std::max(0.0, -linear);
    const bool whole = quadratic <= 0.0 && linear + quadratic < -rounding * scale;
    if (!whole && out.gap <= settings.tolerance * scale) break;
    if (out.iterations >= settings.max_iterations) refuse(out.gap, scale, settings);
    if (whole) {
      mixture = Mixture(vertex);
      crossed = vertex_crossed;
      continue;
    }
    const std::size_t worst = mixture.worst(slope);
    const Matrix exchange = vertex - mixture.atom(worst), exchange_crossed = crossed_of(exchange);
    const double step =
        best_step(slope.cwiseProduct(exchange).sum(), curvature(exchange, exchange_crossed), mixture.share(worst));
    mixture.exchange(worst, vertex, step);
    out.memory_bytes = std::max(out.memory_bytes, mixture.memory_bytes());
    crossed += step * exchange_crossed;
  }
  out.row = simplex.row_potential();
  out.column = simplex.column_potential();
  out.plan = mixture.summed();
  out.value = value_of(problem, out.plan);
  const Eigen::Index held = 8 * out.plan.size() + problem.structure_a.size() + problem.structure_b.size();
  out.memory_bytes += static_cast<std::size_t>(held) * sizeof(double);
  return out;
}

}  // namespace bowstring::gromov
