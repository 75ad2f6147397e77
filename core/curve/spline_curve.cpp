#include "core/curve/spline_curve.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace bowstring {

namespace {

using Index = Eigen::Index;
using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;
constexpr int largest_degree = 5;
using LocalCoefficients = std::array<double, largest_degree + 1>;

std::size_t size(Index i) { return static_cast<std::size_t>(i); }

/// Index of the knot interval [τ_span, τ_span+1) that holds t; the last one for the right end.
int span_of(const std::vector<double>& knots, int degree, double t) {
  const auto above = std::upper_bound(knots.begin() + degree + 1, knots.end() - degree - 1, t);
  return static_cast<int>(above - knots.begin()) - 1;
}

/// Derivative of order `order` at t of the polynomial on `span` with its degree + 1 B-spline coefficients.
/// Each derivative differences the coefficients and lowers the degree; then de Boor's triangle (A Practical
/// Guide to Splines, ch. X).
double evaluate_local(const std::vector<double>& knots, int degree, int span, double t, int order,
                      LocalCoefficients c) {
  if (order > degree) return 0.0;
  const auto knot = [&knots](int i) { return knots[static_cast<std::size_t>(i)]; };
  const auto at = [&c](int i) -> double& { return c[static_cast<std::size_t>(i)]; };
  int p = degree;
  for (; p > degree - order; --p) {
    for (int j = 0; j < p; ++j) {
      const int i = span - p + 1 + j;
      at(j) = p * (at(j + 1) - at(j)) / (knot(i + p) - knot(i));
    }
  }
  for (int level = 1; level <= p; ++level) {
    for (int j = p; j >= level; --j) {
      const int i = span - p + j;
      const double weight = (t - knot(i)) / (knot(i + p - level + 1) - knot(i));
      at(j) = (1.0 - weight) * at(j - 1) + weight * at(j);
    }
  }
  return at(p);
}

/// The derivatives of order `order` at t of the degree + 1 B-splines that do not vanish on `span`.
LocalCoefficients basis(const std::vector<double>& knots, int degree, int span, double t, int order) {
  LocalCoefficients value{};
  for (int j = 0; j <= degree; ++j) {
    LocalCoefficients unit{};
    unit[static_cast<std::size_t>(j)] = 1.0;
    value[static_cast<std::size_t>(j)] = evaluate_local(knots, degree, span, t, order, unit);
  }
  return value;
}

/// The data of a fit, as Dierckx's method sees them.
struct Data {
  std::vector<double> site;
  Eigen::MatrixXd value;  ///< points × dimension
  int degree = largest_degree;

  std::size_t count() const { return site.size(); }
};

Eigen::MatrixXd as_matrix(const std::vector<double>& points, int dimension) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(points.data(), static_cast<Index>(points.size()) / dimension, dimension);
}

/// Knots at the points `inner` (increasing indices) and, degree + 1 times each, at the two ends.
std::vector<double> full_knots(const Data& data, const std::vector<std::size_t>& inner) {
  const std::size_t repeated = static_cast<std::size_t>(data.degree + 1);
  std::vector<double> knots(repeated, data.site.front());
  for (const std::size_t i : inner) knots.push_back(data.site[i]);
  knots.insert(knots.end(), repeated, data.site.back());
  return knots;
}

std::vector<std::size_t> interpolation_knots(const Data& data) {
  std::vector<std::size_t> inner;
  const std::size_t skipped = static_cast<std::size_t>(data.degree + 1) / 2;
  for (std::size_t i = skipped; i + skipped < data.count(); ++i) inner.push_back(i);
  return inner;
}

Sparse collocation(const Data& data, const std::vector<double>& knots) {
  Triplets entries;
  for (std::size_t i = 0; i < data.count(); ++i) {
    const int span = span_of(knots, data.degree, data.site[i]);
    const LocalCoefficients value = basis(knots, data.degree, span, data.site[i], 0);
    for (int j = 0; j <= data.degree; ++j) {
      entries.emplace_back(static_cast<int>(i), span - data.degree + j, value[static_cast<std::size_t>(j)]);
    }
  }
  Sparse matrix(static_cast<Index>(data.count()), static_cast<Index>(knots.size()) - data.degree - 1);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// One row per inner knot: the jump there of the derivative of order `degree`.
Sparse derivative_jumps(int degree, const std::vector<double>& knots) {
  Triplets entries;
  const int inner = static_cast<int>(knots.size()) - 2 * degree - 2;
  for (int row = 0; row < inner; ++row) {
    const int span = row + degree + 1;
    const double t = knots[static_cast<std::size_t>(span)];
    const LocalCoefficients right = basis(knots, degree, span, t, degree);
    const LocalCoefficients left = basis(knots, degree, span - 1, t, degree);
    for (int j = 0; j <= degree; ++j) {
      entries.emplace_back(row, span - degree + j, right[static_cast<std::size_t>(j)]);
      entries.emplace_back(row, span - 1 - degree + j, -left[static_cast<std::size_t>(j)]);
    }
  }
  Sparse matrix(inner, static_cast<Index>(knots.size()) - degree - 1);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Whether the least-squares spline on these knots is unique: every B-spline has a point of its own within
/// its support (Schoenberg and Whitney).
bool determined(const Data& data, const std::vector<double>& knots) {
  const std::size_t order = static_cast<std::size_t>(data.degree + 1);
  const std::size_t unknowns = knots.size() - order;
  std::size_t point = 0;
  for (std::size_t j = 0; j < unknowns; ++j, ++point) {
    const bool begins_here = knots[j] == data.site.front();
    while (point < data.count() && !begins_here && data.site[point] <= knots[j]) ++point;
    const bool ends_here = knots[j + order] == data.site.back();
    if (point >= data.count() || (!ends_here && data.site[point] >= knots[j + order])) return false;
  }
  return true;
}

/// Splines on fixed knots that minimise Σ|p_i − f(t_i)|² + μ Σ|jump|².
class FixedKnots {
 public:
  FixedKnots(const Data& data, std::vector<double> knots) : data_(data), knots_(std::move(knots)) {
    collocation_ = collocation(data_, knots_);
    const Sparse jumps = derivative_jumps(data_.degree, knots_);
    gram_ = collocation_.transpose() * collocation_;
    roughness_ = jumps.transpose() * jumps;
    right_ = collocation_.transpose() * data_.value;
  }

  /// Finds the coefficients for μ and answers the root-mean-square distance; infinity where they are not
  /// determined.
  double solve(double mu) {
    const Sparse matrix = gram_ + mu * roughness_;
    factor_.compute(matrix);
    if (factor_.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    control_ = factor_.solve(right_);
    return measure();
  }

  /// The spline through the points, where there are as many unknowns.
  double interpolate() {
    const Eigen::SparseLU<Sparse> factor(collocation_);
    control_ = factor.solve(data_.value);
    return measure();
  }

  /// The μ at which fit and roughness have matrices of the same size: where a search begins.
  double natural_weight() const { return gram_.diagonal().sum() / roughness_.diagonal().sum(); }
  double square_residual(std::size_t i) const { return residual_.row(static_cast<Index>(i)).squaredNorm(); }

  SplineCurve curve() const {
    const int dimension = static_cast<int>(control_.cols());
    std::vector<double> control(size(control_.size()));
    for (Index i = 0; i < control_.rows(); ++i) {
      for (int k = 0; k < dimension; ++k) control[size(i * dimension + k)] = control_(i, k);
    }
    return SplineCurve(dimension, data_.degree, knots_, std::move(control));
  }

 private:
  double measure() {
    residual_ = data_.value - collocation_ * control_;
    return std::sqrt(residual_.squaredNorm() / static_cast<double>(data_.count()));
  }

  const Data& data_;
  std::vector<double> knots_;
  Sparse collocation_, gram_, roughness_;
  Eigen::MatrixXd right_, control_, residual_;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> factor_;
};

/// A piece of the curve between two knots, while knots are being chosen.
struct Piece {
  std::size_t begin = 0, end = 0;  ///< the points at its ends
  double residual = 0.0;           ///< sum of the squared residuals within
  std::size_t inside() const { return end - begin - 1; }
};

std::vector<Piece> pieces_between(const std::vector<std::size_t>& inner, std::size_t last_point) {
  std::vector<Piece> pieces;
  std::size_t begin = 0;
  for (const std::size_t knot : inner) {
    pieces.push_back({begin, knot, 0.0});
    begin = knot;
  }
  pieces.push_back({begin, last_point, 0.0});
  return pieces;
}

/// Residuals of each piece; that of a point which is a knot counts half on either side.
std::vector<Piece> measured_pieces(const std::vector<std::size_t>& inner, const Data& data, const FixedKnots& fit) {
  std::vector<Piece> pieces = pieces_between(inner, data.count() - 1);
  for (Piece& piece : pieces) {
    for (std::size_t i = piece.begin; i <= piece.end; ++i) {
      const bool shared = (i == piece.begin && i != 0) || (i == piece.end && i + 1 != data.count());
      piece.residual += (shared ? 0.5 : 1.0) * fit.square_residual(i);
    }
  }
  return pieces;
}

/// Splits the worst piece that has a point inside, at its middle point; its residual is shared out by the
/// number of points. False where no piece has one.
bool split_worst(std::vector<Piece>& pieces) {
  const auto worse = [](const Piece& a, const Piece& b) {
    return (a.inside() > 0 ? a.residual : -1.0) < (b.inside() > 0 ? b.residual : -1.0);
  };
  const auto worst = std::max_element(pieces.begin(), pieces.end(), worse);
  if (worst->inside() == 0) return false;
  const double per_point = worst->residual / static_cast<double>(worst->inside());
  const std::size_t middle = worst->begin + worst->inside() / 2 + 1;
  Piece second{middle, worst->end, 0.0};
  worst->end = middle;
  worst->residual = per_point * static_cast<double>(worst->inside());
  second.residual = per_point * static_cast<double>(second.inside());
  pieces.insert(worst + 1, second);
  return true;
}

/// How many knots to add: what the last ones brought, extrapolated to what is missing, but no more than twice
/// and no fewer than half as many as the last time.
std::size_t knots_to_add(std::size_t last_time, double gained, double missing) {
  const double wanted = gained > 0.0 ? static_cast<double>(last_time) * missing / gained : 1e9;
  const std::size_t most = 2 * last_time;
  const std::size_t least = std::max<std::size_t>(last_time / 2, 1);
  if (wanted >= static_cast<double>(most)) return most;
  return std::min(most, std::max(least, static_cast<std::size_t>(std::max(wanted, 0.0))));
}

/// Inner knots on which the least-squares spline leaves no more than `distance`.
std::vector<std::size_t> smoothing_knots(const Data& data, double distance) {
  const std::size_t most = interpolation_knots(data).size();
  const double allowed = distance * distance * static_cast<double>(data.count());
  std::vector<std::size_t> inner;
  std::size_t added = 0;
  double before = 0.0;
  while (true) {
    const std::vector<double> knots = full_knots(data, inner);
    if (inner.size() >= most || !determined(data, knots)) return interpolation_knots(data);
    FixedKnots fit(data, knots);
    const double left = std::pow(fit.solve(0.0), 2) * static_cast<double>(data.count());
    if (!std::isfinite(left)) return interpolation_knots(data);
    if (left <= allowed) return inner;
    added = added == 0 ? 1 : knots_to_add(added, before - left, left - allowed);
    before = left;
    std::vector<Piece> pieces = measured_pieces(inner, data, fit);
    for (std::size_t i = 0; i < added; ++i) {
      if (!split_worst(pieces)) return interpolation_knots(data);
    }
    inner.clear();
    for (std::size_t i = 1; i < pieces.size(); ++i) inner.push_back(pieces[i].begin);
  }
}

/// Leaves in `fit` the spline whose distance is `distance`, which increases with μ: regula falsi in log μ
/// that halves the retained end's value (Illinois), which keeps the bracket and converges superlinearly.
/// False where rounding leaves it more than a thousandth away.
bool meet_distance(FixedKnots& fit, double distance) {
  constexpr double tolerance = 1e-10;
  constexpr double acceptable = 1e-3;
  constexpr int most_steps = 100;
  const double stride = std::log(100.0);
  const auto excess = [&](double log_mu) { return std::log(fit.solve(std::exp(log_mu)) / distance); };
  double low = std::log(fit.natural_weight());
  double at_low = excess(low);
  double high = low;
  double at_high = at_low;
  for (int step = 0; at_low > 0.0 && step < most_steps; ++step) {
    high = low;
    at_high = at_low;
    low -= stride;
    at_low = excess(low);
  }
  for (int step = 0; at_high <= 0.0 && step < most_steps; ++step) {
    low = high;
    at_low = at_high;
    high += stride;
    at_high = excess(high);
  }
  if (!(at_low <= 0.0 && at_high > 0.0)) return false;
  double value = at_low;
  for (int step = 0; step < most_steps && high - low > tolerance; ++step) {
    const double middle = (low * at_high - high * at_low) / (at_high - at_low);
    value = excess(middle);
    if (std::abs(value) <= tolerance) break;
    if (value > 0.0) {
      high = middle;
      at_high = value;
      at_low *= 0.5;
    } else {
      low = middle;
      at_low = value;
      at_high *= 0.5;
    }
  }
  return std::abs(value) <= acceptable;
}

Status distance_not_met(const Data& data, double distance) {
  const auto shorter = [&data](std::size_t i, std::size_t j) {
    return data.site[i + 1] - data.site[i] < data.site[j + 1] - data.site[j];
  };
  std::size_t closest = 0;
  for (std::size_t i = 1; i + 1 < data.count(); ++i) {
    if (shorter(i, closest)) closest = i;
  }
  const double mean_count = static_cast<double>(data.count() - 1);
  std::ostringstream text;
  text << "smoothing " << distance << " mm cannot be met to rounding; expected more, or points spaced evenly (points "
       << closest + 1 << " and " << closest + 2 << " are the closest, "
       << (data.site[closest + 1] - data.site[closest]) * mean_count / (data.site.back() - data.site.front())
       << " of the mean step apart); change the smoothing or remove points that nearly coincide";
  return Status::failure(Code::invalid_input, text.str());
}

}  // namespace

SplineCurve::SplineCurve(int dimension, int degree, std::vector<double> knots, std::vector<double> control)
    : dimension_(dimension), degree_(degree), knots_(std::move(knots)), control_(std::move(control)) {}

std::vector<double> SplineCurve::breaks() const {
  return std::vector<double>(knots_.begin() + degree_, knots_.end() - degree_);
}

void SplineCurve::evaluate(double parameter, int order, double* out) const {
  const int span = span_of(knots_, degree_, parameter);
  for (int k = 0; k < dimension_; ++k) {
    LocalCoefficients local{};
    for (int j = 0; j <= degree_; ++j) {
      local[static_cast<std::size_t>(j)] = control_[static_cast<std::size_t>((span - degree_ + j) * dimension_ + k)];
    }
    out[k] = evaluate_local(knots_, degree_, span, parameter, order, local);
  }
}

double SplineCurve::speed(double parameter) const {
  double d[3] = {0.0, 0.0, 0.0};
  evaluate(parameter, 1, d);
  return std::hypot(d[0], d[1], d[2]);
}

double SplineCurve::curvature(double parameter) const {
  double d[3] = {0.0, 0.0, 0.0};
  double e[3] = {0.0, 0.0, 0.0};
  evaluate(parameter, 1, d);
  evaluate(parameter, 2, e);
  const double cross = std::hypot(d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]);
  return cross / std::pow(std::hypot(d[0], d[1], d[2]), 3);
}

std::vector<double> SplineCurve::tangent(double parameter) const {
  std::vector<double> direction(static_cast<std::size_t>(dimension_));
  evaluate(parameter, 1, direction.data());
  const double length = speed(parameter);
  for (double& value : direction) value /= length;
  return direction;
}

ArcLength SplineCurve::arc_length() const {
  return ArcLength([this](double parameter) { return speed(parameter); }, breaks());
}

std::vector<double> chord_parameters(const std::vector<double>& points, int dimension) {
  std::vector<double> parameter = polyline_arc(points, dimension);
  const double mean_step = parameter.back() / static_cast<double>(parameter.size() - 1);
  for (double& value : parameter) value /= mean_step;
  return parameter;
}

Status fit_spline(const std::vector<double>& parameter, const std::vector<double>& points, int dimension, int degree,
                  double distance, SplineFit& out) {
  if (parameter.size() <= static_cast<std::size_t>(degree)) {
    return Status::failure(Code::invalid_input, "a spline of degree " + std::to_string(degree) + " through " +
                                                    std::to_string(parameter.size()) + " points; expected at least " +
                                                    std::to_string(degree + 1));
  }
  const Data data{parameter, as_matrix(points, dimension), degree};
  const std::vector<std::size_t> inner = distance > 0.0 ? smoothing_knots(data, distance) : interpolation_knots(data);
  FixedKnots fit(data, full_knots(data, inner));
  if (distance > 0.0 && !inner.empty()) {
    if (!meet_distance(fit, distance)) return distance_not_met(data, distance);
    out.distance = distance;
  } else {
    out.distance = distance > 0.0 ? fit.solve(0.0) : fit.interpolate();
  }
  out.curve = fit.curve();
  return {};
}

}  // namespace bowstring
