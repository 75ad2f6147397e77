#include "core/check/mode_names.hpp"

#include <algorithm>

#include "core/check/motion.hpp"
#include "core/check/unknowns.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

using Dense = Eigen::MatrixXd;
using Numbers = Eigen::VectorXd;

constexpr double within = 1e-3;  // of a mode's square outside a family of motions that it still belongs to

class ModeNames {
 public:
  ModeNames(const Assembly& assembly, const Numbers& scale)
      : assembly_(assembly), n_(assembly.unknowns()), scale_(scale) {}

 private:
  /// Removes from the span of `modes` those of a family, and says how many they were. The family: the unknowns marked
  /// in `inside`, and the orthonormal `columns`.
  int take(const std::vector<Numbers>& columns, const std::vector<char>& inside, Dense& modes) const {
    if (modes.cols() == 0) return 0;
    Dense outside = modes;
    for (int u = 0; u < n_; ++u) {
      if (inside[at(u)] != 0) outside.row(u).setZero();
    }
    for (const Numbers& column : columns) outside -= column * (column.transpose() * modes);
    const Eigen::SelfAdjointEigenSolver<Dense> eigen(outside.transpose() * outside);
    Eigen::Index count = 0;
    while (count < modes.cols() && eigen.eigenvalues()[count] <= within) ++count;
    modes = (modes * eigen.eigenvectors().rightCols(modes.cols() - count)).eval();
    return static_cast<int>(count);
  }

  /// Each node's unit tangent as a direction of the unknowns, where its position is free.
  std::vector<Numbers> tangents(const std::vector<double>& q, const FieldGroup& group) const {
    std::vector<Numbers> out;
    const int d = assembly_.scene().dimension;
    const double* p = q.data() + assembly_.entries()[at(group.entry_begin)].coordinate;
    const int nodes = group.field->count;
    for (int i = 0; i < nodes; ++i) {
      const FieldEntry& entry = assembly_.entries()[at(group.entry_begin + i)];
      const double* before = p + std::max(i - 1, 0) * d;
      const double* after = p + std::min(i + 1, nodes - 1) * d;
      Numbers column = Numbers::Zero(n_);
      for (int k = 0; k < d; ++k) {
        const int u = assembly_.free_of_unknown()[at(entry.unknown + k)];
        if (u >= 0) column[u] = after[k] - before[k];
      }
      if (column.norm() > 0.0) out.push_back(column.normalized());
    }
    return out;
  }

  int take_sliding(const std::vector<double>& q, int curve, Dense& modes) const {
    std::vector<char> inside(at(n_), 0);
    std::vector<Numbers> columns;
    for (const FieldGroup& group : field_groups(assembly_)) {
      if (group.curve != curve) continue;
      if (group.field->manifold == Manifold::real)
        std::fill(inside.begin() + group.begin, inside.begin() + group.end, 1);
      if (group.field->manifold == Manifold::vector) columns = tangents(q, group);
    }
    return take(columns, inside, modes);
  }

  int take_twist(int curve, Dense& modes) const {
    std::vector<char> inside(at(n_), 0);
    for (const FieldGroup& group : field_groups(assembly_)) {
      if (group.curve != curve || assembly_.scene().dimension == 2) continue;
      for (int i = group.entry_begin; i < group.entry_end; ++i) {
        const FieldEntry& entry = assembly_.entries()[at(i)];
        const bool turns = entry.manifold == Manifold::rotation || entry.manifold == Manifold::circle;
        const int u = assembly_.free_of_unknown()[at(entry.unknown)];
        if (turns && u >= 0) inside[at(u)] = 1;
      }
    }
    return take({}, inside, modes);
  }

  bool moves_held(const std::vector<double>& rate) const {
    for (std::size_t u = 0; u < rate.size(); ++u) {
      if (assembly_.free_of_unknown()[u] < 0 && rate[u] != 0.0) return true;
    }
    return false;
  }

  /// Where the energies' second derivatives vanish, rigid motions may be among the modes though energies resist them
  /// farther away.
  int take_rigid(const std::vector<double>& q, int curve, Dense& modes) const {
    const Mover mover(assembly_);
    const int d = assembly_.scene().dimension;
    const int count = d * (d + 1) / 2;
    Dense motions = Dense::Zero(n_, count);
    std::vector<double> rate;
    for (int k = 0; k < count; ++k) {
      RigidMotion motion;
      if (k < d) motion.shift = Vector3::unit(k);
      if (k >= d) motion.turn = Vector3::unit(d == 2 ? 2 : k - d);
      motion.centre = mover.centre(q, curve);
      if (!mover.rate(q, curve, motion, rate).ok()) return 0;
      if (moves_held(rate)) continue;
      const std::vector<double> own = free_part(assembly_, rate);
      for (int u = 0; u < n_; ++u) motions(u, k) = scale_[u] * own[at(u)];
    }
    const Eigen::ColPivHouseholderQR<Dense> qr(motions);
    const Dense basis = qr.householderQ() * Dense::Identity(n_, qr.rank());
    std::vector<Numbers> columns;
    for (Eigen::Index k = 0; k < basis.cols(); ++k) columns.emplace_back(basis.col(k));
    return take(columns, std::vector<char>(at(n_), 0), modes);
  }

 public:
  std::vector<ModeFamily> families(const std::vector<double>& q, Dense modes) const {
    std::vector<ModeFamily> out;
    for (const auto& curve : assembly_.scene().curves) {
      const std::string subject = "'" + curve->name + "'";
      const auto add = [&](int count, const char* text) {
        if (count > 0) out.push_back({subject, count, text});
      };
      add(take_rigid(q, curve->view.index, modes), "at the start it is free to move as a rigid body");
      add(take_sliding(q, curve->view.index, modes), "its nodes may slide along it");
      add(take_twist(curve->view.index, modes), "single frames may turn about their tangents");
      if (modes.cols() == 0) return out;
    }
    Eigen::Index most = 0;
    modes.rowwise().norm().maxCoeff(&most);
    out.push_back({"the scene", static_cast<int>(modes.cols()),
                   "what moves most is " + unknown_name(assembly_, static_cast<int>(most))});
    return out;
  }

 private:
  const Assembly& assembly_;
  int n_;
  const Numbers& scale_;
};

}  // namespace

std::vector<ModeFamily> mode_families(const Assembly& assembly, const std::vector<double>& q, const Numbers& scale,
                                      Dense modes) {
  return ModeNames(assembly, scale).families(q, std::move(modes));
}

std::vector<CheckLine> name_modes(const Assembly& assembly, const std::vector<double>& q, const Numbers& scale,
                                  Dense modes, bool at_least) {
  constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
  std::vector<CheckLine> out;
  for (const ModeFamily& family : mode_families(assembly, q, scale, std::move(modes))) {
    const std::string what =
        family.subject == "the scene" ? " near zero that no rigid motion explains; " : " near zero: ";
    out.push_back({CheckVerdict::note, family.subject, "soft modes", unjudged, "",
                   (at_least ? "at least " : "") + std::to_string(family.count) + what + family.text});
  }
  return out;
}

}  // namespace bowstring::checking
