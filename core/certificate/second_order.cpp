#include "core/certificate/second_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "core/certificate/activity.hpp"
#include "core/certificate/neutral_modes.hpp"
#include "core/check/unknowns.hpp"
#include "core/composition/nearest.hpp"
#include "core/kkt/kkt_system.hpp"

namespace bowstring {

namespace {

using checking::at;
using checking::field_groups;
using checking::FieldGroup;
using Dense = Eigen::MatrixXd;
using Numbers = Eigen::VectorXd;

constexpr double pi = 3.14159265358979323846;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double zero_share = 1e-5;      // of a curve's longest bending wave: less curvature is none
constexpr double residual_share = 10.0;  // so many times the stationarity are not told from zero force
constexpr double turn_radius = 0.03;     // of a curve's length: what a turn counts in the metric
constexpr double bound_reach = 1e-6;     // relative: a real unknown so near its bound lies on it
constexpr double bound_hold = 1e6;       // of the largest stiffness: what holds it there
constexpr int most_modes = 12;           // that are looked for
constexpr int extra_modes = 2;           // so that those which are wanted converge
constexpr int sweeps = 8;
constexpr int refinements = 2;

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// The lower triangle of the Hessian, and sums with it.
struct Symmetric {
  SparsityPattern pattern;
  Span<const double> values;

  /// xᵀ W x, and Σ |x_i W_ij x_j| to tell what rounding leaves of it.
  double form(const double* x, double& size) const {
    double sum = 0.0;
    size = 0.0;
    for (int j = 0; j + 1 < static_cast<int>(pattern.begin.size()); ++j) {
      for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
        const int i = pattern.inner[at(k)];
        const double term = (i == j ? 1.0 : 2.0) * x[i] * values[at(k)] * x[j];
        sum += term;
        size += std::fabs(term);
      }
    }
    return sum;
  }

  Dense product(const Dense& x) const {
    Dense out = Dense::Zero(x.rows(), x.cols());
    for (int j = 0; j + 1 < static_cast<int>(pattern.begin.size()); ++j) {
      for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
        const int i = pattern.inner[at(k)];
        out.row(i) += values[at(k)] * x.row(j);
        if (i != j) out.row(j) += values[at(k)] * x.row(i);
      }
    }
    return out;
  }
};

/// Per free unknown, what its square weighs: lengths per mm of curve, and the curvatures that count as zero.
struct Metric {
  Numbers length;  ///< mm of curve that a position stands for; 0 elsewhere
  Numbers zero;    ///< N/mm: curvature that counts as none
  Numbers shift;   ///< N/mm: ≥ zero; curvature that a factorization tells from none
};

class Judge {
 public:
  Judge(Assembly& assembly, Span<const double> q, Span<const double> multipliers, double stationarity, SecondOrder& out)
      : assembly_(assembly),
        q_(q.begin(), q.end()),
        multipliers_(multipliers.begin(), multipliers.end()),
        stationarity_(stationarity),
        n_(assembly.unknowns()),
        m_(assembly.rows()),
        out_(out) {}

  void run() {
    if (n_ == 0) return conclude(Curvature::minimum, "nothing is unknown");
    if (Status status = evaluate(); !status.ok()) return conclude(Curvature::unjudged, status.text);
    hold_bounds();
    if (!make_metric()) return conclude(Curvature::unjudged, "no energy has a second derivative here");
    judge();
  }

 private:
  /// Eigenvalues below and at zero with a set of rows held, and their directions.
  struct Spectrum {
    bool exists = false, at_least = false;
    int negative = 0;
    Dense neutral;     ///< columns
    Numbers leftmost;  ///< of a negative eigenvalue that was met; empty: none was
  };

  void conclude(Curvature curvature, std::string reason) {
    out_.curvature = curvature;
    out_.reason = std::move(reason);
  }

  Status evaluate() {
    const SparsityPattern jacobian = assembly_.jacobian_pattern(), hessian = assembly_.hessian_pattern();
    jacobian_.resize(at(jacobian.entries()));
    hessian_.resize(at(hessian.entries()));
    residual_.resize(at(m_));
    ProblemEvaluation wanted;
    wanted.jacobian = jacobian_;
    wanted.rows = residual_;
    if (Status status = assembly_.evaluate(q_, wanted); !status.ok()) return status;
    find_activity();
    if (Status status = assembly_.lagrangian_hessian(q_, 1.0, multipliers_, hessian_); !status.ok()) return status;
    for (int u = 0; u < n_; ++u) {
      const int k = hessian.begin[at(u)];
      if (k == hessian.begin[at(u) + 1] || hessian.inner[at(k)] != u) {
        return Status::failure(Code::failed,
                               "neither an energy nor a row reads " + checking::unknown_name(assembly_, u));
      }
    }
    for (const double value : hessian_) {
      if (!std::isfinite(value)) return Status::failure(Code::failed, "a second derivative is not finite");
    }
    return {};
  }

  /// What an interior point leaves on rows that carry nothing in the limit is taken off: its curvature would pass for
  /// stiffness where nothing else holds.
  void find_activity() {
    held_.assign(at(m_), 0);
    const SparsityPattern pattern = assembly_.jacobian_pattern();
    for (int r = 0; r < m_; ++r) {
      const double lower = assembly_.row_lower()[at(r)], upper = assembly_.row_upper()[at(r)];
      if (lower == upper) continue;
      const Activity found = activity(row_side(lower, upper, residual_[at(r)], multipliers_[at(r)]));
      if (found == Activity::open || found == Activity::weak) multipliers_[at(r)] = 0.0;
      const auto begin = jacobian_.begin() + pattern.begin[at(r)], end = jacobian_.begin() + pattern.begin[at(r) + 1];
      if (found == Activity::open || std::all_of(begin, end, [](double value) { return value == 0.0; })) continue;
      if (found == Activity::strong) {
        held_[at(r)] = 1;
        ++strong_;
      } else {
        weak_.push_back(r);
      }
    }
  }

  /// A real unknown on its bound stays there.
  void hold_bounds() {
    std::vector<double> value(at(n_));
    assembly_.values(q_, value);
    const SparsityPattern pattern = assembly_.hessian_pattern();
    double stiffest = 0.0;
    for (int u = 0; u < n_; ++u) stiffest = std::max(stiffest, std::fabs(diagonal(u)));
    for (int u = 0; u < n_; ++u) {
      const double lower = assembly_.lower()[at(u)], upper = assembly_.upper()[at(u)];
      const bool held = (std::isfinite(lower) && value[at(u)] - lower <= bound_reach * (1.0 + std::fabs(lower))) ||
                        (std::isfinite(upper) && upper - value[at(u)] <= bound_reach * (1.0 + std::fabs(upper)));
      if (held) hessian_[at(pattern.begin[at(u)])] += bound_hold * stiffest;
    }
  }

  double diagonal(int u) const { return hessian_[at(assembly_.hessian_pattern().begin[at(u)])]; }

  struct Share {
    double arc = 0.0, edge = 0.0;  ///< mm: of curve that an entry stands for; the shortest edge beside it
  };
  static Share share(const CurveView& view, int count, int k) {
    const int edges = view.nodes - 1;
    if (count == edges) return {view.edge_length[k], view.edge_length[k]};
    if (count == view.nodes) {
      const double before = view.edge_length[std::max(k - 1, 0)], after = view.edge_length[std::min(k, edges - 1)];
      const double arc = 0.5 * ((k > 0 ? before : 0.0) + (k < edges ? after : 0.0));
      return {arc, std::min(before, after)};
    }
    return {view.arc[edges] / count, view.arc[edges] / std::max(edges, count)};
  }

  /// EI of a rod that would be as stiff as the stiffest place of each curve: 2 EI/h³ at one edge's turn, per h².
  std::vector<double> bending_of_curves() const {
    const Scene& scene = assembly_.scene();
    std::vector<double> out(scene.curves.size(), 0.0);
    for (const FieldGroup& group : field_groups(assembly_)) {
      if (group.field->count == 1) continue;  // a whole length tells nothing of a place
      const CurveView& view = scene.curves[at(group.curve)]->view;
      for_unknowns(group, [&](int u, int k, const FieldEntry&) {
        const double h = share(view, group.field->count, k).edge, scale = assembly_.stationarity_scale()[at(u)];
        out[at(group.curve)] =
            std::max(out[at(group.curve)], 0.5 * std::fabs(diagonal(u)) * h * h * h / (scale * scale));
      });
    }
    const double largest = out.empty() ? 0.0 : *std::max_element(out.begin(), out.end());
    for (double& bending : out) bending = bending > 0.0 ? bending : largest;
    return out;
  }

  template <class Act>
  void for_unknowns(const FieldGroup& group, const Act& act) const {
    for (int e = group.entry_begin; e < group.entry_end; ++e) {
      const FieldEntry& entry = assembly_.entries()[at(e)];
      if (entry.block < 0) continue;
      const auto& begin = assembly_.blocks().begin;
      for (int u = begin[at(entry.block)]; u < begin[at(entry.block) + 1]; ++u) act(u, e - group.entry_begin, entry);
    }
  }

  bool make_metric() {
    const std::vector<double> bending = bending_of_curves();
    metric_.length = metric_.zero = metric_.shift = Numbers::Zero(n_);
    for (const FieldGroup& group : field_groups(assembly_)) {
      const CurveView& view = assembly_.scene().curves[at(group.curve)]->view;
      const double stiffness = bending[at(group.curve)];
      if (!(stiffness > 0.0)) return false;
      const double length = view.arc[view.nodes - 1];
      const double wave = stiffness * std::pow(pi / length, 4);  // N/mm²
      const double force = residual_share * stationarity_ / (stiffness * std::pow(pi / length, 2));
      const double zero = std::max(zero_share, force);
      const double rounding = epsilon * 16.0 * std::pow(view.nodes / pi, 4);
      for_unknowns(group, [&](int u, int k, const FieldEntry& entry) {
        const double arc = share(view, group.field->count, k).arc;
        const bool moves = entry.manifold == Manifold::vector, turns = !moves && entry.manifold != Manifold::real;
        const double mass = turns ? arc * std::pow(turn_radius * length, 2) : arc;
        if (moves) metric_.length[u] = arc;
        metric_.zero[u] = zero * wave * mass;
        metric_.shift[u] = std::max(zero, rounding) * wave * mass;
      });
    }
    return true;
  }

  /// Negative eigenvalues of W + s · metric on the null space of what is held; −1: no factor exists.
  int negative(double s) {
    constexpr int attempts = 3;
    constexpr double aside = 1.21;
    const SparsityPattern pattern = assembly_.hessian_pattern();
    for (int k = 0; k < attempts; ++k, s *= aside) {
      shifted_ = hessian_;
      for (int u = 0; u < n_; ++u) shifted_[at(pattern.begin[at(u)])] += s * metric_.shift[u];
      const kkt::KktSystem::Outcome outcome = system_.factor({shifted_, jacobian_, off_, 0.0});
      ++out_.factorizations;
      if (outcome.exists) return outcome.saddle_directions;
    }
    return -1;
  }

  /// Inverse iteration with the last factors: orthonormal directions (columns, in the metric) by rising curvature.
  Dense softest(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Numbers root = metric_.shift.cwiseSqrt();
    const Symmetric hessian{assembly_.hessian_pattern(), hessian_};
    Dense x(n_, std::min(count, n_));
    for (Eigen::Index k = 0; k < x.size(); ++k) x.data()[k] = uniform(random) / root[k % n_];
    std::vector<double> right(at(n_)), none(at(m_), 0.0), delta(at(n_)), lambda(at(m_));
    for (int s = 0; s < sweeps; ++s) {
      for (Eigen::Index k = 0; k < x.cols(); ++k) {
        for (int u = 0; u < n_; ++u) right[at(u)] = metric_.shift[u] * x(u, k);
        system_.solve(right, none, {}, refinements, delta, lambda);
        x.col(k) = Eigen::Map<const Numbers>(delta.data(), n_);
        x.col(k) /= (root.array() * x.col(k).array()).matrix().norm();
      }
      // What is held leaves fewer dimensions than columns where few nodes are free.
      Eigen::ColPivHouseholderQR<Dense> qr(root.asDiagonal() * x);
      qr.setThreshold(1e-9);
      const Dense basis = root.cwiseInverse().asDiagonal() * (qr.householderQ() * Dense::Identity(n_, qr.rank()));
      const Eigen::SelfAdjointEigenSolver<Dense> ritz(basis.transpose() * hessian.product(basis));
      x = basis * ritz.eigenvectors();
    }
    return x;
  }

  /// Curvature along one direction: −1, 0, 1. Without the elimination of places, so that less is lost to rounding.
  int sign_along(const Numbers& x) const {
    double size = 0.0;
    const double value = Symmetric{assembly_.hessian_pattern(), hessian_}.form(x.data(), size);
    const double zero = (metric_.zero.array() * x.array().square()).sum() + 2.0 * epsilon * size;
    return value < -zero ? -1 : value <= zero ? 0 : 1;
  }

  Spectrum spectrum(const std::vector<char>& held) {
    Spectrum out;
    system_.analyse(assembly_, jacobian_, held);
    off_.assign(at(m_), infinity);
    const int below = negative(-1.0);
    if (below < 0) return out;
    out.exists = true;
    if (below == 0) return out;
    out.negative = negative(1.0);
    out.exists = out.negative >= 0;
    if (out.negative != 0) return out;
    const int wanted = std::min(below, most_modes);
    out.at_least = below > wanted;
    const Dense x = softest(wanted + extra_modes);
    std::vector<Eigen::Index> neutral;
    for (Eigen::Index k = 0; k < std::min<Eigen::Index>(wanted, x.cols()); ++k) {
      const int sign = sign_along(x.col(k));
      if (sign < 0 && out.negative++ == 0) out.leftmost = x.col(k);
      if (sign == 0) neutral.push_back(k);
    }
    out.neutral = x(Eigen::all, neutral);
    return out;
  }

  /// The most negative direction: inverse iteration from a shift that only just leaves no eigenvalue below it.
  void find_leftmost(Spectrum& found) {
    if (found.leftmost.size() == 0) {
      double low = 1.0, high = 1.0;
      constexpr int most_steps = 16;
      for (int k = 0; k < most_steps && negative(high) > 0; ++k) low = high, high *= 16.0;
      for (int k = 0; k < 4; ++k) {
        const double middle = std::sqrt(low * high);
        (negative(middle) > 0 ? low : high) = middle;
      }
      if (negative(high) != 0) return;
      found.leftmost = softest(1 + extra_modes).col(0);
    }
    double size = 0.0;
    const double value = Symmetric{assembly_.hessian_pattern(), hessian_}.form(found.leftmost.data(), size);
    const double moved = (metric_.length.array() * found.leftmost.array().square()).sum();
    if (moved > 0.0) out_.leftmost_curvature = value / moved;
    out_.leftmost_mode = describe_direction(assembly_, found.leftmost);
  }

  void conclude_saddle(Spectrum& found) {
    out_.negative_directions = found.negative;
    find_leftmost(found);
    const std::string curvature =
        out_.leftmost_curvature ? ", the most negative " + number(*out_.leftmost_curvature) + " N/mm^2" : "";
    const std::string mode = out_.leftmost_mode.empty() ? "" : ": " + out_.leftmost_mode;
    conclude(Curvature::saddle, counted(found.negative, "direction") + " of negative curvature" + curvature + mode);
  }

  void conclude_neutral(const Spectrum& found) {
    out_.neutral_modes = name_neutral_modes(assembly_, q_, jacobian_, metric_.shift, found.neutral, found.at_least);
    conclude(Curvature::degenerate, std::string(found.at_least ? "at least " : "") +
                                        counted(static_cast<int>(found.neutral.cols()), "direction") +
                                        " without curvature: " + joined(out_.neutral_modes, "; "));
  }

  void conclude_unfactored() { conclude(Curvature::unjudged, "the reduced Hessian could not be factorised"); }

  void judge() {
    Spectrum strong = spectrum(held_);
    if (!strong.exists) return conclude_unfactored();
    if (strong.negative == 0 && strong.neutral.cols() == 0) {
      return conclude(Curvature::minimum,
                      strong_ == 0 ? "every curvature is positive"
                                   : "every curvature is positive with " + counted(strong_, "pressing row") + " held");
    }
    if (weak_.empty()) return strong.negative > 0 ? conclude_saddle(strong) : conclude_neutral(strong);
    std::vector<char> all = held_;
    for (const int r : weak_) all[at(r)] = 1;
    Spectrum held = spectrum(all);
    if (!held.exists) return conclude_unfactored();
    if (held.negative > 0) return conclude_saddle(held);
    if (held.neutral.cols() > 0) return conclude_neutral(held);
    out_.deciding_rows = weak_;
    std::vector<std::string> rows;
    for (const int r : weak_) rows.push_back(std::to_string(r));
    conclude(
        Curvature::degenerate,
        std::string("curvature is ") + (strong.negative > 0 ? "negative" : "zero") +
            " where rows open that touch and carry nothing, and positive while they hold: " + comma_separated(rows));
  }

  Assembly& assembly_;
  std::vector<double> q_, multipliers_;
  double stationarity_;
  int n_, m_, strong_ = 0;
  SecondOrder& out_;
  std::vector<double> jacobian_, hessian_, shifted_, residual_, off_;
  std::vector<char> held_;
  std::vector<int> weak_;
  Metric metric_;
  kkt::KktSystem system_;
};

}  // namespace

const char* curvature_name(Curvature curvature) noexcept {
  switch (curvature) {
    case Curvature::minimum:
      return "minimum";
    case Curvature::saddle:
      return "saddle";
    case Curvature::degenerate:
      return "degenerate";
    case Curvature::unjudged:
      break;
  }
  return nullptr;
}

void judge_second_order(Assembly& assembly, Span<const double> q, Span<const double> multipliers, double stationarity,
                        SecondOrder& out) {
  out = {};
  Judge(assembly, q, multipliers, stationarity, out).run();
}

}  // namespace bowstring
