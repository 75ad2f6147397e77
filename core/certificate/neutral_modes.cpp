#include "core/certificate/neutral_modes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/check/free_motions.hpp"
#include "core/check/mode_names.hpp"
#include "core/check/unknowns.hpp"

namespace bowstring {

namespace {

using checking::at;
using Dense = Eigen::MatrixXd;
using Numbers = Eigen::VectorXd;

constexpr double within = 1e-3;  // of a motion's square outside the neutral directions that it still belongs to
constexpr double noise = 1e-5;   // of a combination's entries
constexpr double along = 1e-4;   // of a motion's square across the curve, if the curve slides along itself
constexpr double same = 1e-7;    // rates that differ by less are one

std::string number(double value, double scale) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", std::fabs(value) <= 5e-4 * scale ? 0.0 : value);
  return text;
}

/// Reduced echelon form of the columns' span, with what inverse iteration left of zeros removed; orthonormal again.
Dense cleaned(Dense columns) {
  std::set<Eigen::Index> used;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    Eigen::Index pivot = -1;
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      if (used.count(i) == 0 && (pivot < 0 || std::fabs(columns(i, k)) > std::fabs(columns(pivot, k)))) pivot = i;
    }
    if (pivot < 0 || columns(pivot, k) == 0.0) continue;
    used.insert(pivot);
    columns.col(k) /= columns(pivot, k);
    for (Eigen::Index l = 0; l < columns.cols(); ++l) {
      if (l != k) columns.col(l) -= columns(pivot, l) * columns.col(k);
    }
  }
  for (double& entry : columns.reshaped()) entry = std::fabs(entry) <= noise ? 0.0 : entry;
  return Eigen::HouseholderQR<Dense>(columns).householderQ() * Dense::Identity(columns.rows(), columns.cols());
}

class Namer {
 public:
  Namer(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& jacobian, const Numbers& metric,
        const Dense& modes, bool at_least)
      : assembly_(assembly), q_(q), jacobian_(jacobian), root_(metric.cwiseSqrt()), mover_(assembly) {
    least_ = at_least ? "at least " : "";
    modes_ = Eigen::HouseholderQR<Dense>(root_.asDiagonal() * modes).householderQ() *
             Dense::Identity(modes.rows(), modes.cols());
  }

  std::vector<std::string> run() {
    for (const std::vector<int>& curves : candidates()) {
      if (modes_.cols() > 0) take_rigid(curves);
    }
    if (modes_.cols() > 0) name_rest();
    return out_;
  }

 private:
  bool moves(int curve) const { return assembly_.scene().curves[at(curve)]->unknowns > 0; }

  /// Bodies, then those that rows of any kind tie together, then all curves: those that have unknowns.
  std::vector<std::vector<int>> candidates() const {
    std::vector<std::vector<int>> out;
    const auto add = [&](std::vector<int> curves) {
      curves.erase(std::remove_if(curves.begin(), curves.end(), [&](int c) { return !moves(c); }), curves.end());
      std::sort(curves.begin(), curves.end());
      curves.erase(std::unique(curves.begin(), curves.end()), curves.end());
      if (!curves.empty() && std::find(out.begin(), out.end(), curves) == out.end()) out.push_back(curves);
    };
    std::vector<int> all;
    for (const auto& curve : assembly_.scene().curves) all.push_back(curve->view.index);
    for (const auto& body : checking::bodies(assembly_)) add(body);
    for (const ConstraintUse& use : assembly_.scene().constraints) {
      std::vector<int> touching;
      for (const CurveView& view : use.scene.on) touching.push_back(view.index);
      add(touching);
    }
    add(all);
    return out;
  }

  std::string subject(const std::vector<int>& curves) const {
    std::string out;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      out += std::string(k == 0                  ? ""
                         : k + 1 < curves.size() ? ", "
                                                 : " and ") +
             "'" + assembly_.scene().curves[at(curves[k])]->name + "'";
    }
    return out;
  }

  Numbers free_rate(const checking::Body& body, const Numbers& coefficients) const {
    const std::vector<double> rate = checking::free_part(assembly_, body.rate(coefficients));
    return (root_.array() * Eigen::Map<const Numbers>(rate.data(), root_.size()).array()).matrix();
  }

  /// Combinations of motions that lie among the modes; these are taken out of the modes.
  Dense taken(const checking::Body& body, const Dense& motions) {
    Dense rates(root_.size(), motions.cols());
    for (Eigen::Index k = 0; k < motions.cols(); ++k) rates.col(k) = free_rate(body, motions.col(k));
    const Eigen::SelfAdjointEigenSolver<Dense> gram(rates.transpose() * rates);
    const double largest = gram.eigenvalues().maxCoeff();
    if (!(largest > 0.0)) return Dense(motions.cols(), 0);
    Eigen::Index still = 0;
    while (gram.eigenvalues()[still] <= same * largest) ++still;
    const Eigen::Index count = motions.cols() - still;
    const Dense to_motions =
        gram.eigenvectors().rightCols(count) * gram.eigenvalues().tail(count).cwiseSqrt().cwiseInverse().asDiagonal();
    const Dense basis = rates * to_motions;
    const Dense outside = basis - modes_ * (modes_.transpose() * basis);
    const Eigen::SelfAdjointEigenSolver<Dense> eigen(outside.transpose() * outside);
    Eigen::Index found = 0;
    while (found < count && eigen.eigenvalues()[found] <= within) ++found;
    if (found == 0) return Dense(motions.cols(), 0);
    remove(basis * eigen.eigenvectors().leftCols(found));
    return to_motions * eigen.eigenvectors().leftCols(found);
  }

  /// The modes without what lies in the span of these orthonormal columns.
  void remove(const Dense& columns) {
    const Dense outside = modes_ - columns * (columns.transpose() * modes_);
    const Eigen::SelfAdjointEigenSolver<Dense> eigen(outside.transpose() * outside);
    const Eigen::Index left = std::max<Eigen::Index>(0, modes_.cols() - columns.cols());
    modes_ = (modes_ * eigen.eigenvectors().rightCols(left)).eval();
  }

  void take_rigid(const std::vector<int>& curves) {
    const checking::Body body(assembly_, mover_, q_, curves);
    if (!body.status().ok()) return;
    const Dense admissible = body.admissible(jacobian_);
    if (admissible.cols() == 0) return;
    const Dense found = taken(body, admissible);
    if (found.cols() == 0) return;
    const Dense motions = cleaned(admissible * found);
    const Dense spinning = checking::null_space(node_rates(body, motions), 1e-4);
    const Dense moving = checking::null_space(spinning.transpose(), 0.5);
    if (moving.cols() > 0) {
      const Dense rigid = cleaned(motions * moving);
      const std::string slides = rigid.cols() == 1 ? slides_along(body, rigid.col(0)) : "";
      out_.push_back(least_ + subject(curves) + " may move as " +
                     (curves.size() > 1 ? "one rigid body" : "a rigid body") + ": " +
                     checking::describe_motions(body, rigid, assembly_.scene().dimension) + slides);
    }
    if (spinning.cols() > 0) {
      out_.push_back(least_ + subject(curves) + " may turn about " +
                     (spinning.cols() == 1 ? "its tangent" : "their tangents"));
    }
  }

  /// Rates of node positions alone.
  Dense node_rates(const checking::Body& body, const Dense& motions) const {
    Dense out = Dense::Zero(static_cast<Eigen::Index>(assembly_.free_of_unknown().size()), motions.cols());
    for (Eigen::Index k = 0; k < motions.cols(); ++k) {
      const std::vector<double> rate = body.rate(motions.col(k));
      for (const FieldEntry& entry : assembly_.entries()) {
        if (entry.manifold != Manifold::vector) continue;
        for (int i = 0; i < entry.dimension; ++i) out(entry.unknown + i, k) = rate[at(entry.unknown + i)];
      }
    }
    return out;
  }

  /// ", by which it slides along 'tube'": a motion that takes every node along the curve's tangent.
  std::string slides_along(const checking::Body& body, const Numbers& motion) const {
    if (body.curves().size() != 1) return "";
    const Dense rates = node_rates(body, motion);
    const Curve& curve = *assembly_.scene().curves[at(body.curves().front())];
    const int d = assembly_.scene().dimension;
    double across = 0.0, all = 0.0;
    for (const checking::FieldGroup& group : checking::field_groups(assembly_)) {
      if (group.curve != curve.view.index || group.field->manifold != Manifold::vector) continue;
      const int nodes = group.field->count;
      const double* p = q_.data() + assembly_.entries()[at(group.entry_begin)].coordinate;
      for (int i = 0; i < nodes; ++i) {
        const Eigen::Map<const Numbers> before(p + std::max(i - 1, 0) * d, d),
            after(p + std::min(i + 1, nodes - 1) * d, d);
        const Numbers tangent = (after - before).normalized();
        const Numbers rate = rates.col(0).segment(assembly_.entries()[at(group.entry_begin + i)].unknown, d);
        all += rate.squaredNorm();
        across += (rate - rate.dot(tangent) * tangent).squaredNorm();
      }
    }
    if (!(all > 0.0) || across > along * all) return "";
    for (const ConstraintUse& use : assembly_.scene().constraints) {
      if (use.scene.on.size() != 2 || use.scene.on[0].index != curve.view.index) continue;
      return ", by which it slides along '" + std::string(use.scene.on[1].name) + "'";
    }
    return ", by which it slides along itself";
  }

  void name_rest() {
    Numbers scale(root_.size());
    for (Eigen::Index u = 0; u < scale.size(); ++u) scale[u] = assembly_.stationarity_scale()[at(static_cast<int>(u))];
    const Dense own = scale.cwiseQuotient(root_).asDiagonal() * modes_;
    const Dense orthonormal = Eigen::HouseholderQR<Dense>(own).householderQ() * Dense::Identity(own.rows(), own.cols());
    for (const checking::ModeFamily& family : checking::mode_families(assembly_, q_, scale, orthonormal)) {
      out_.push_back(least_ + std::to_string(family.count) + " of " + family.subject + ": " + family.text);
    }
  }

  Assembly& assembly_;
  const std::vector<double>& q_;
  const std::vector<double>& jacobian_;
  Numbers root_;
  checking::Mover mover_;
  Dense modes_;  // orthonormal, in unknowns times the metric's root
  std::string least_;
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> name_neutral_modes(Assembly& assembly, const std::vector<double>& q,
                                            const std::vector<double>& jacobian, const Numbers& metric,
                                            const Dense& modes, bool at_least) {
  return Namer(assembly, q, jacobian, metric, modes, at_least).run();
}

std::string describe_direction(const Assembly& assembly, const Numbers& direction) {
  const FieldEntry* most = nullptr;
  Numbers furthest;
  for (const FieldEntry& entry : assembly.entries()) {
    if (entry.manifold != Manifold::vector || entry.block < 0) continue;
    Numbers rate = Numbers::Zero(entry.dimension);
    for (int k = 0; k < entry.dimension; ++k) {
      const int u = assembly.free_of_unknown()[at(entry.unknown + k)];
      if (u >= 0) rate[k] = direction[u];
    }
    if (most == nullptr || rate.squaredNorm() > furthest.squaredNorm()) most = &entry, furthest = rate;
  }
  if (most == nullptr || furthest.norm() == 0.0) return "";
  furthest.normalize();
  Eigen::Index largest = 0;
  furthest.cwiseAbs().maxCoeff(&largest);
  if (furthest[largest] < 0.0) furthest = -furthest;
  std::string axis;
  for (Eigen::Index k = 0; k < furthest.size(); ++k) axis += (k > 0 ? ", " : "") + number(furthest[k], 1.0);
  for (const auto& curve : assembly.scene().curves) {
    const int local = most->unknown - curve->unknown_begin;
    if (local < 0 || local >= curve->unknowns) continue;
    const double length = curve->arc.back();
    return "'" + curve->name + "' moves most at s = " + number(most->arc_fraction * length, length) + " mm, along (" +
           axis + ")";
  }
  return "";
}

}  // namespace bowstring
