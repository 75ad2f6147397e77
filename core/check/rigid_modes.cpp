#include "core/check/rigid_modes.hpp"

#include <algorithm>
#include <cmath>

#include "core/check/free_motions.hpp"
#include "core/check/unknowns.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
constexpr double excursion = 0.05;     // of the body's radius: how far energies are followed
constexpr double no_stiffness = 1e-9;  // of what the Hessian's diagonal alone would give
constexpr double least_force = 1e-10;  // N: less is rounding, far below what a certificate asks for
constexpr double no_force = 1e-8;      // of what the gradient's entries would give if none cancelled
constexpr double same = 1e-7;

class RigidSearch {
 public:
  RigidSearch(Assembly& assembly, const std::vector<double>& q) : assembly_(assembly), q_(q), mover_(assembly) {
    jacobian_.resize(at(assembly.jacobian_pattern().entries()));
    std::vector<double> gradient(at(assembly.unknowns()));
    ProblemEvaluation wanted;
    wanted.jacobian = jacobian_;
    wanted.gradient = gradient;
    usable_ = assembly.evaluate(q, wanted).ok();
    gradient_ = gradient;
    find_diagonal();
  }

  RigidModes run() {
    if (!usable_) return out_;
    for (const std::vector<int>& curves : bodies(assembly_)) judge(curves);
    return out_;
  }

 private:
  void find_diagonal() {
    const SparsityPattern pattern = assembly_.hessian_pattern();
    std::vector<double> hessian(at(pattern.entries())), none(at(assembly_.rows()), 0.0);
    usable_ = usable_ && assembly_.lagrangian_hessian(q_, 1.0, none, hessian).ok();
    diagonal_.assign(at(assembly_.unknowns()), 0.0);
    for (int j = 0; usable_ && j < assembly_.unknowns(); ++j) {
      for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
        if (pattern.inner[at(k)] == j) diagonal_[at(j)] = std::fabs(hessian[at(k)]);
      }
    }
  }

  /// A load that keeps its direction resists nothing: along a translation its energy is linear.
  bool is_load(const EnergyUse& use) const {
    return std::all_of(use.laws.begin(), use.laws.end(),
                       [](const LawUse& law) { return law.description.linear && !law.description.objective; });
  }

  bool belongs(const EnergyUse& use, const Body& body) const {
    return std::find(body.curves().begin(), body.curves().end(), use.curve) != body.curves().end();
  }

  /// Of the terms on a body's curves.
  Status energy(const Body& body, bool loads, const Eigen::VectorXd& coefficients, double t, double& out) {
    std::vector<double> moved, terms;
    if (Status status = body.moved(coefficients, t, moved); !status.ok()) return status;
    if (Status status = assembly_.term_energies(moved, terms); !status.ok()) return status;
    out = 0.0;
    for (std::size_t e = 0; e < terms.size(); ++e) {
      const EnergyUse& use = assembly_.scene().energies[e];
      if (belongs(use, body) && (loads || !is_load(use))) out += terms[e];
    }
    return {};
  }

  struct Response {
    double stiffness = 0.0, force = 0.0;  ///< N/mm and N along a motion
  };
  Status response(const Body& body, bool loads, const Eigen::VectorXd& coefficients, Response& out) {
    const double t = excursion * body.radius();
    double back = 0.0, here = 0.0, forth = 0.0;
    if (Status status = energy(body, loads, coefficients, -t, back); !status.ok()) return status;
    if (Status status = energy(body, loads, coefficients, 0.0, here); !status.ok()) return status;
    if (Status status = energy(body, loads, coefficients, t, forth); !status.ok()) return status;
    out.stiffness = (forth - 2.0 * here + back) / (t * t);
    out.force = (forth - back) / (2.0 * t);
    return {};
  }

  double stiffness_scale(const Body& body, const Eigen::VectorXd& coefficients) const {
    const std::vector<double> rate = free_part(assembly_, body.rate(coefficients));
    double out = 0.0;
    for (std::size_t u = 0; u < rate.size(); ++u) out += diagonal_[u] * rate[u] * rate[u];
    return out;
  }

  double force_scale(const Body& body, const Eigen::VectorXd& coefficients) const {
    const std::vector<double> rate = free_part(assembly_, body.rate(coefficients));
    double out = 0.0;
    for (std::size_t u = 0; u < rate.size(); ++u) out += std::fabs(gradient_[u] * rate[u]);
    return out;
  }

  /// Of the admissible motions those that no energy resists: the null space of the quadratic form by polarisation.
  Status unresisted(const Body& body, bool loads, const Eigen::MatrixXd& admissible, Eigen::MatrixXd& out) {
    const Eigen::Index n = admissible.cols();
    Eigen::MatrixXd form(n, n);
    double scale = 0.0;
    Response found;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (Status status = response(body, loads, admissible.col(i), found); !status.ok()) return status;
      form(i, i) = found.stiffness;
      scale = std::max(scale, stiffness_scale(body, admissible.col(i)));
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) {
        if (Status status = response(body, loads, admissible.col(i) + admissible.col(j), found); !status.ok())
          return status;
        form(i, j) = form(j, i) = 0.5 * (found.stiffness - form(i, i) - form(j, j));
      }
    }
    if (scale == 0.0) scale = std::max(form.cwiseAbs().maxCoeff(), 1e-300);
    out = admissible * null_space(form / scale, no_stiffness);
    return {};
  }

  /// Whether a load acts along a translation among the motions, and so without end.
  bool driven(const Body& body, const Eigen::MatrixXd& motions) {
    const Eigen::MatrixXd shifting = motions * translations_among(body, motions);
    const double t = excursion * body.radius();
    Response found;
    for (Eigen::Index k = 0; k < shifting.cols(); ++k) {
      if (!response(body, true, shifting.col(k), found).ok()) continue;
      const double least = least_force + no_force * force_scale(body, shifting.col(k)) +
                           no_stiffness * t * stiffness_scale(body, shifting.col(k));
      if (std::fabs(found.force) > least) return true;
    }
    return false;
  }

  /// Ends and energies hold the rest. What only loads hold, like a pendulum, counts as held.
  Status free_motions(const Body& body, const Eigen::MatrixXd& admissible, Eigen::MatrixXd& out, bool& is_driven) {
    if (Status status = unresisted(body, false, admissible, out); !status.ok() || out.cols() == 0) return status;
    for (Eigen::Index k = 0; k < out.cols(); ++k) out_.rates.push_back(body.rate(out.col(k)));
    is_driven = driven(body, out);
    const auto& energies = assembly_.scene().energies;
    const bool loaded = std::any_of(energies.begin(), energies.end(),
                                    [&](const EnergyUse& use) { return belongs(use, body) && is_load(use); });
    if (is_driven || !loaded) return {};
    if (Status status = unresisted(body, true, Eigen::MatrixXd(out), out); !status.ok()) return status;
    return unmoved(body, out);
  }

  /// Of the motions those along which loads do no work at first: the others end where the load hangs.
  Status unmoved(const Body& body, Eigen::MatrixXd& motions) {
    Eigen::MatrixXd work(1, motions.cols());
    Response found;
    for (Eigen::Index k = 0; k < motions.cols(); ++k) {
      if (Status status = response(body, true, motions.col(k), found); !status.ok()) return status;
      const bool none = std::fabs(found.force) <= no_force * force_scale(body, motions.col(k));
      work(0, k) = none ? 0.0 : found.force;
    }
    const double largest = work.size() > 0 ? work.cwiseAbs().maxCoeff() : 0.0;
    if (largest > 0.0) motions = (motions * null_space(work / largest, same)).eval();
    return {};
  }

  void judge(const std::vector<int>& curves) {
    const Body body(assembly_, mover_, q_, curves);
    if (!body.status().ok())
      return line(CheckVerdict::note, body, "rigid motions", "not judged: " + body.status().text);
    const Eigen::MatrixXd admissible = body.admissible(jacobian_);
    if (admissible.cols() == 0) return line(CheckVerdict::ok, body, "rigid motions", "the ends hold them all");
    Eigen::MatrixXd modes;
    bool is_driven = false;
    if (Status status = free_motions(body, admissible, modes, is_driven); !status.ok()) {
      return line(CheckVerdict::note, body, "rigid motions", "not judged: " + status.text);
    }
    if (modes.cols() == 0) return line(CheckVerdict::ok, body, "rigid motions", "ends and energies hold them all");
    name(body, modes, is_driven);
  }

  /// Rates of the node positions alone.
  Eigen::MatrixXd node_rates(const Body& body, const Eigen::MatrixXd& modes) const {
    Eigen::MatrixXd out =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(assembly_.free_of_unknown().size()), modes.cols());
    for (Eigen::Index k = 0; k < modes.cols(); ++k) {
      const std::vector<double> rate = body.rate(modes.col(k));
      for (const FieldEntry& entry : assembly_.entries()) {
        if (entry.manifold != Manifold::vector) continue;
        for (int i = 0; i < entry.dimension; ++i) out(entry.unknown + i, k) = rate[at(entry.unknown + i)];
      }
    }
    return out;
  }

  void name(const Body& body, const Eigen::MatrixXd& modes, bool is_driven) {
    const Eigen::MatrixXd spinning = null_space(node_rates(body, modes), same);
    const Eigen::MatrixXd moving = null_space(spinning.transpose(), 0.5);
    const int dimension = assembly_.scene().dimension;
    if (moving.cols() > 0) {
      report(body, is_driven, "rigid motions",
             std::to_string(moving.cols()) + " free: " + describe_motions(body, modes * moving, dimension));
    }
    if (spinning.cols() > 0) {
      report(body, false, "twist",
             spinning.cols() == 1 ? "it may turn about its tangent" : "they may turn about their tangents");
    }
  }

  void report(const Body& body, bool is_driven, const std::string& what, const std::string& text) {
    if (touched(body)) {
      line(CheckVerdict::note, body, what, text + "; inequality rows alone can hold that");
    } else if (is_driven) {
      line(CheckVerdict::failed, body, what,
           text + "; a load drives that and nothing resists: there is no equilibrium");
    } else {
      line(CheckVerdict::note, body, what, text + "; nothing resists, so that the equilibrium is not unique");
    }
  }

  /// Whether an inequality row reads a curve of the body.
  bool touched(const Body& body) const {
    for (const ConstraintUse& use : assembly_.scene().constraints) {
      for (int r = 0; r < use.rows.rows; ++r) {
        if (use.rows.lower[at(r)] == use.rows.upper[at(r)]) continue;
        for (int p = use.rows.place_begin[at(r)]; p < use.rows.place_begin[at(r) + 1]; ++p) {
          const auto& curves = body.curves();
          if (std::find(curves.begin(), curves.end(), use.rows.places[at(p)].curve) != curves.end()) return true;
        }
      }
    }
    return false;
  }

  void line(CheckVerdict verdict, const Body& body, const std::string& what, const std::string& text) {
    std::string subject;
    for (const int curve : body.curves()) {
      subject += (subject.empty() ? "'" : " and '") + assembly_.scene().curves[at(curve)]->name + "'";
    }
    out_.lines.push_back({verdict, subject, what, unjudged, "", text});
  }

  Assembly& assembly_;
  const std::vector<double>& q_;
  Mover mover_;
  bool usable_ = false;
  std::vector<double> jacobian_, gradient_, diagonal_;
  RigidModes out_;
};

}  // namespace

RigidModes find_rigid_modes(Assembly& assembly, const std::vector<double>& q) { return RigidSearch(assembly, q).run(); }

}  // namespace bowstring::checking
