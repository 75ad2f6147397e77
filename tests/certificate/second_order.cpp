#include "core/certificate/second_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "core/certificate/activity.hpp"
#include "core/certificate/multipliers.hpp"
#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

using Dense = Eigen::MatrixXd;
constexpr double pi = 3.14159265358979323846;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Eigenvalues of the Lagrangian's Hessian on the null space of equality rows and strongly active inequality rows, each
/// unknown in mm, by dense algebra alone. Relative to the largest.
struct DenseSpectrum {
  Eigen::VectorXd values;
  int held = 0;
  int negative(double threshold) const { return static_cast<int>((values.array() < -threshold).count()); }
  double smallest() const { return values.cwiseAbs().minCoeff(); }
};

DenseSpectrum dense_spectrum(Assembly& assembly, const std::vector<double>& q, std::vector<double> multipliers) {
  const int n = assembly.unknowns(), m = assembly.rows();
  const SparsityPattern rows = assembly.jacobian_pattern(), pattern = assembly.hessian_pattern();
  std::vector<double> jacobian(at(rows.entries())), hessian(at(pattern.entries())), residual(at(m));
  ProblemEvaluation wanted;
  wanted.jacobian = jacobian;
  wanted.rows = residual;
  REQUIRE(assembly.evaluate(q, wanted).ok());
  std::vector<char> holds(at(m), 1);
  for (int r = 0; r < m; ++r) {
    const double lower = assembly.row_lower()[at(r)], upper = assembly.row_upper()[at(r)];
    if (lower == upper) continue;
    holds[at(r)] = activity(row_side(lower, upper, residual[at(r)], multipliers[at(r)])) == Activity::strong;
    if (holds[at(r)] == 0) multipliers[at(r)] = 0.0;
  }
  REQUIRE(assembly.lagrangian_hessian(q, 1.0, multipliers, hessian).ok());
  const Span<const double> scale = assembly.stationarity_scale();
  Dense w = Dense::Zero(n, n), a = Dense::Zero(m, n);
  for (int j = 0; j < n; ++j) {
    for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
      const int i = pattern.inner[at(k)];
      w(i, j) = w(j, i) = hessian[at(k)] / (scale[at(i)] * scale[at(j)]);
    }
  }
  DenseSpectrum out;
  for (int r = 0; r < m; ++r) {
    if (holds[at(r)] == 0) continue;
    const bool equality = assembly.row_lower()[at(r)] == assembly.row_upper()[at(r)];
    out.held += equality ? 0 : 1;
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) {
      const int u = rows.inner[at(k)];
      a(r, u) = jacobian[at(k)] / scale[at(u)];
    }
    if (a.row(r).norm() > 0.0) a.row(r).normalize();
  }
  const Eigen::JacobiSVD<Dense> svd(a, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-10) ++rank;
  const Dense z = svd.matrixV().rightCols(n - rank);
  const Eigen::SelfAdjointEigenSolver<Dense> eigen(z.transpose() * w * z);
  out.values = eigen.eigenvalues() / eigen.eigenvalues().cwiseAbs().maxCoeff();
  return out;
}

SecondOrder judged(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& multipliers,
                   double stationarity = 0.0) {
  SecondOrder out;
  judge_second_order(assembly, q, multipliers, stationarity, out);
  INFO(out.reason);
  CHECK(out.curvature != Curvature::unjudged);
  return out;
}

std::string name(const SecondOrder& second) {
  const char* text = curvature_name(second.curvature);
  return text == nullptr ? "" : text;
}

/// A straight rod along x under a dead axial force at its last end, which slides along x.
struct Column {
  int nodes = 21;
  double stiffness = 1000.0, length = 100.0;
  std::string kinematics = "edge-frames";
  int dimension = 2;
  std::string ends = R"(["pinned", { position = ["free", "held"] }])";
  std::string energies;
  std::string text() const {
    const auto number = [](double value) {
      char out[40];
      std::snprintf(out, sizeof out, "%.17g", value);
      return std::string(out);
    };
    return "schema = 1\n[scene]\ndimension = " + std::to_string(dimension) +
           "\n[[wire]]\nname = \"rod\"\nradius = \"0.1 mm\"\nkinematics = \"" + kinematics +
           "\"\ngeometry = { type = \"line\", length = \"" + number(length) +
           " mm\", nodes = " + std::to_string(nodes) + " }\nends = " + ends +
           "\n[[energy]]\ntype = \"wire-bending\"\non = \"rod\"\nbending-stiffness = \"" + number(stiffness) +
           " N mm^2\"\n" + energies + "[solver]\ntype = \"ipopt\"\n";
  }
  /// Of the discrete rod: hinges of stiffness EI/h between rigid edges.
  double critical_force() const {
    const double h = length / (nodes - 1);
    return 4.0 * stiffness / (h * h) * std::pow(std::sin(pi * h / (2.0 * length)), 2);
  }
};

std::string pushed(double force, int dimension = 2) {
  char text[200];
  std::snprintf(text, sizeof text,
                "[[energy]]\ntype = \"point-load\"\non = \"rod\"\nat = \"last\"\nforce = [%.17g, 0%s]\n", -force,
                dimension == 3 ? ", 0" : "");
  return text;
}

Solution solved_column(Column column, double force, std::unique_ptr<Session>* session = nullptr,
                       const std::string& more = "") {
  column.energies += pushed(force, column.dimension);
  auto made = session_of_text(column.text() + more);
  Solution solution = solve(*made, {});
  INFO(solution.certificate.reason);
  REQUIRE(solution.certificate.first_order);
  if (session != nullptr) *session = std::move(made);
  return solution;
}

}  // namespace

TEST_CASE("rows are open, undecided, weakly or strongly active by distance and multiplier") {
  const auto of = [](double distance, double multiplier) { return activity({0.0, distance, multiplier}); };
  CHECK(of(1e-9, 1e-3) == Activity::strong);
  CHECK(of(5e-7, 2e-6) == Activity::strong);
  CHECK(of(5e-5, 1.0) == Activity::strong);
  CHECK(of(1e-9, 1e-9) == Activity::weak);
  CHECK(of(0.0, -1e-9) == Activity::weak);
  CHECK(of(3e-5, 3e-5) == Activity::undecided);
  CHECK(of(1e-5, 9e-4) == Activity::strong);
  CHECK(of(9e-5, 5e-7) == Activity::open);
  CHECK(of(1.0, 1e-9) == Activity::open);
  const RowSide upper = row_side(-INFINITY, 0.0, -2.0, 3.0), lower = row_side(1.0, INFINITY, 1.5, -3.0);
  CHECK(upper.distance == 2.0);
  CHECK(upper.multiplier == 3.0);
  CHECK(lower.distance == 0.5);
  CHECK(lower.multiplier == 3.0);
}

TEST_CASE("inertias are those of dense algebra, at states that are far from any equilibrium") {
  int saddles = 0, held = 0;
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const char* contact : {"node-wise-contact", "segment-wise-contact"}) {
        for (unsigned seed = 1; seed <= 4; ++seed) {
          CAPTURE(dimension);
          CAPTURE(std::string(kinematics));
          CAPTURE(std::string(contact));
          CAPTURE(seed);
          SmallScene small;
          small.dimension = dimension;
          small.vessel_kinematics = small.wire_kinematics = kinematics;
          small.contact_type = contact;
          small.vessel_frames = dimension == 3 && seed % 2 == 0;
          const auto session = session_of(small);
          Assembly& assembly = *session->assembly;
          const std::vector<double> q = moved_start(*session, 0.3, seed);
          REQUIRE(assembly.accept(q).ok());
          std::vector<double> multipliers = random_numbers(assembly.rows(), 100 + seed);
          const RowOrigin rows = contact_rows(assembly);
          for (int r = 0; r < assembly.rows(); ++r) {
            const bool signed_row = r >= rows.first && r < rows.first + rows.count;
            multipliers[at(r)] *= signed_row ? 20.0 : seed;
            if (signed_row) multipliers[at(r)] = std::fabs(multipliers[at(r)]) * (r % 2);
          }
          const DenseSpectrum dense = dense_spectrum(assembly, q, multipliers);
          REQUIRE(dense.smallest() > 1e-7);
          const SecondOrder found = judged(assembly, q, multipliers);
          CHECK(found.negative_directions == dense.negative(0.0));
          CHECK(name(found) == (dense.negative(0.0) > 0 ? "saddle" : "minimum"));
          saddles += dense.negative(0.0) > 0 ? 1 : 0;
          held += dense.held;
        }
      }
    }
  }
  REQUIRE(saddles > 6);
  REQUIRE(saddles < 32);
  REQUIRE(held > 32);
}

TEST_CASE("a compressed straight rod: minimum below the buckling force, degenerate at it, saddle beyond") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(std::string(kinematics));
    for (const int nodes : {11, 101}) {
      CAPTURE(nodes);
      Column column;
      column.kinematics = kinematics;
      column.nodes = nodes;
      const double critical = column.critical_force();
      CHECK(critical == doctest::Approx(1000.0 * pi * pi / 1e4).epsilon(1e-2));
      for (const double share : {0.0, 0.5, 0.99, 0.9999}) {
        CHECK(name(solved_column(column, share * critical).certificate.second_order) == "minimum");
      }
      for (const double share : {1.0001, 1.15171962, 3.9}) {
        CAPTURE(share);
        const SecondOrder second = solved_column(column, share * critical).certificate.second_order;
        CHECK(name(second) == "saddle");
        CHECK(second.negative_directions == 1);
        REQUIRE(second.leftmost_curvature.has_value());
        // Of sin(πs/L): EI(π/L)⁴ (1 − P/P_E).
        const double wave = 1000.0 * std::pow(pi / 100.0, 4);
        CHECK(*second.leftmost_curvature == doctest::Approx((1.0 - share) * wave).epsilon(0.03));
        CHECK(contains(second.leftmost_mode, "'rod' moves most at s = 50 mm, along (0, 1)"));
      }
      CHECK(solved_column(column, 5.0 * critical).certificate.second_order.negative_directions == 2);
      const SecondOrder at_it = solved_column(column, critical).certificate.second_order;
      CHECK(name(at_it) == "degenerate");
      REQUIRE(at_it.neutral_modes.size() == 1);
      CHECK(contains(at_it.neutral_modes.front(), "1 of the scene: what moves most is "));
    }
  }
}

TEST_CASE("the post-buckled rod is a minimum, its straight state is none") {
  const auto session = session_of_file("buckled-rod.toml");
  CHECK(name(solve(*session, {}).certificate.second_order) == "minimum");
}

TEST_CASE("fine meshes: the softest mode is not taken for none") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(std::string(kinematics));
    for (const int nodes : {1281, 5121}) {
      CAPTURE(nodes);
      for (const char* ends : {R"(["pinned", "pinned"])", R"(["clamped", "free"])"}) {
        CAPTURE(std::string(ends));
        Column column;
        column.kinematics = kinematics;
        column.nodes = nodes;
        column.ends = ends;
        const auto session = session_of_text(column.text());
        const std::vector<double> none(at(session->assembly->rows()), 0.0);
        const SecondOrder found = judged(*session->assembly, session->scene->start_coordinates(), none);
        CHECK_MESSAGE(name(found) == "minimum", found.reason);
      }
    }
  }
}

TEST_CASE("fine meshes: a hundredth of the buckling force decides") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    for (const int nodes : {641, 2561}) {
      for (const double share : {0.99, 1.01}) {
        CAPTURE(std::string(kinematics));
        CAPTURE(nodes);
        CAPTURE(share);
        Column column;
        column.kinematics = kinematics;
        column.nodes = nodes;
        const SecondOrder found = solved_column(column, share * column.critical_force()).certificate.second_order;
        CHECK_MESSAGE(name(found) == (share < 1.0 ? "minimum" : "saddle"), found.reason);
        CHECK(found.negative_directions == (share < 1.0 ? 0 : 1));
      }
    }
  }
}

TEST_CASE("free rods: rigid motions are named, in the plane and in space, and what turns about its tangent") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(std::string(kinematics));
    Column column;
    column.kinematics = kinematics;
    column.ends = R"(["free", "free"])";
    for (const int nodes : {11, 321, 5121}) {
      CAPTURE(nodes);
      column.nodes = nodes;
      const auto session = session_of_text(column.text());
      const std::vector<double> none(at(session->assembly->rows()), 0.0);
      const SecondOrder found = judged(*session->assembly, session->scene->start_coordinates(), none);
      CHECK(name(found) == "degenerate");
      REQUIRE(found.neutral_modes.size() == 1);
      CHECK(found.neutral_modes.front() ==
            "'rod' may move as a rigid body: translations along every axis and a rotation");
    }
    column.nodes = 21;
    column.dimension = 3;
    const auto session = session_of_text(column.text());
    const std::vector<double> none(at(session->assembly->rows()), 0.0);
    const SecondOrder found = judged(*session->assembly, session->scene->start_coordinates(), none);
    CHECK(name(found) == "degenerate");
    REQUIRE(found.neutral_modes.size() == 1);
    CHECK(found.neutral_modes.front() ==
          "'rod' may move as a rigid body: translations along every axis and rotations about every axis across x");
    column.energies =
        "[[energy]]\ntype = \"vessel-strain\"\non = \"rod\"\nbending-stiffness = \"5 N mm^2\"\n"
        "torsional-stiffness = \"9 N mm^2\"\n";
    column.ends = R"(["pinned", "pinned"])";
    const auto twisting = session_of_text(column.text());
    const std::vector<double> nothing(at(twisting->assembly->rows()), 0.0);
    const SecondOrder twist = judged(*twisting->assembly, twisting->scene->start_coordinates(), nothing);
    CHECK(name(twist) == "degenerate");
    REQUIRE(twist.neutral_modes.size() == 1);
    CHECK(twist.neutral_modes.front() == "'rod' may turn about its tangent");
    column.ends = R"(["clamped", "pinned"])";
    const auto held = session_of_text(column.text());
    const std::vector<double> zero(at(held->assembly->rows()), 0.0);
    CHECK(name(judged(*held->assembly, held->scene->start_coordinates(), zero)) == "minimum");
  }
}

TEST_CASE("contact: the planar iliac is a minimum on every mesh, for both kinematics") {
  for (const char* nodes : {"12", "20", "40", "80"}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      CAPTURE(std::string(nodes));
      CAPTURE(std::string(kinematics));
      const auto session = session_of_file("planar-iliac-smooth.toml", {{"vessel.iliac.geometry.nodes", nodes},
                                                                        {"vessel.iliac.kinematics", kinematics},
                                                                        {"wire.lunderquist.kinematics", kinematics}});
      const Solution solution = solve(*session, {});
      CHECK_MESSAGE(name(solution.certificate.second_order) == "minimum", solution.certificate.second_order.reason);
      CHECK(solution.certificate.second_order.factorizations == 1);
      if (std::string(nodes) != "80") {
        const DenseSpectrum dense = dense_spectrum(*session->assembly, solution.q, solution.multipliers);
        REQUIRE(dense.held > 0);
        CHECK(dense.values.minCoeff() > 0.0);
      }
    }
  }
}

TEST_CASE("a rod in a tube that bends in an arc slides along it where nothing holds it") {
  const auto session = session_of_file("rod-in-arc-tube.toml", {{"wire.rod.ends", "['free', 'free']"}});
  const Solution solution = solve(*session, {});
  REQUIRE(solution.certificate.verdict == Verdict::converged);
  const SecondOrder& second = solution.certificate.second_order;
  CHECK_MESSAGE(name(second) == "degenerate", second.reason);
  REQUIRE(second.neutral_modes.size() == 1);
  CHECK(second.neutral_modes.front() ==
        "'rod' may move as a rigid body: a rotation about (0, 2000) mm, by which it slides along 'tube'");
}

TEST_CASE("what a barrier leaves on open rows is no stiffness") {
  // L² < 16 c R: the rod touches nothing, and turns about its first end.
  const auto session = session_of_file("rod-in-arc-tube.toml", {{"vessel.tube.radius", "1.2"}});
  const Solution solution = solve(*session, {});
  REQUIRE(solution.certificate.verdict == Verdict::converged);
  REQUIRE(largest(solution.multipliers) > 0.0);
  const SecondOrder& second = solution.certificate.second_order;
  CHECK_MESSAGE(name(second) == "degenerate", second.reason);
  REQUIRE(second.neutral_modes.size() == 1);
  CHECK(second.neutral_modes.front() == "'rod' may move as a rigid body: a translation along y and a rotation");
}

TEST_CASE("rows that touch and carry nothing decide: with them the straight rod stays, without them it buckles") {
  // The rod lies on the wall of a straight tube, 0.5 mm off its axis.
  Column column;
  const double critical = column.critical_force();
  const std::string tube =
      "[[vessel]]\nname = \"tube\"\nrigid = true\nradius = \"0.6 mm\"\ngeometry = { type = \"line\", length = \"140 "
      "mm\", nodes = 141, origin = [\"-20 mm\", \"0.5 mm\"] }\n";
  const std::string contact =
      "[[constraint]]\nname = \"lumen\"\ntype = \"node-wise-contact\"\non = [\"rod\", \"tube\"]\n";
  for (const double share : {0.9, 1.0, 1.5}) {
    CAPTURE(share);
    Column loaded = column;
    loaded.energies = pushed(share * critical) + tube + contact;
    const auto session = session_of_text(loaded.text());
    Assembly& assembly = *session->assembly;
    const std::vector<double> q = session->scene->start_coordinates();
    std::vector<double> multipliers;
    REQUIRE(estimate_multipliers(assembly, q, 1e-6, multipliers).ok());
    const Certificate found = certified(assembly, q, multipliers, CertificateTable());
    INFO(found.reason);
    REQUIRE(found.first_order);
    const RowOrigin rows = contact_rows(assembly);
    REQUIRE(rows.count >= 19);
    CHECK(static_cast<int>(found.weakly_active.size()) == rows.count);
    CHECK(name(found.second_order) == (share < 1.0 ? "minimum" : "degenerate"));
    CHECK(found.second_order.neutral_modes.empty());
    if (share < 1.0) {
      CHECK(found.second_order.deciding_rows.empty());
    } else {
      CHECK(found.second_order.deciding_rows.size() == 19);  // those whose node is held read nothing
      CHECK(contains(found.second_order.reason, share > 1.0 ? "curvature is negative where rows open that touch"
                                                            : "curvature is zero where rows open that touch"));
    }
  }
}

TEST_CASE("rows that say the same twice are held once") {
  const SmallScene small = contact_scene(2);
  const SolvedScene once = solved(session_of_text(contact_text(small)));
  REQUIRE(name(once.solution.certificate.second_order) == "minimum");
  std::string text = contact_text(small);
  text.insert(text.find("[solver]"),
              "[[constraint]]\nname = \"again\"\ntype = \"node-wise-contact\"\non = [\"wire\", \"vessel\"]\n");
  const auto session = session_of_text(text);
  Assembly& assembly = *session->assembly;
  REQUIRE(assembly.accept(once.solution.q).ok());
  const RowOrigin rows = contact_rows(assembly);
  std::vector<double> multipliers = once.solution.multipliers;
  REQUIRE(assembly.rows() == static_cast<int>(multipliers.size()) + rows.count);
  multipliers.resize(at(assembly.rows()));
  for (int r = 0; r < rows.count; ++r) {
    multipliers[at(rows.first + rows.count + r)] = multipliers[at(rows.first + r)] *= 0.5;
  }
  const SecondOrder twice = judged(assembly, once.solution.q, multipliers);
  CHECK(name(twice) == "minimum");
}

TEST_CASE("require = \"minimum\": a saddle is stalled, and says why") {
  Column column;
  const std::string more = "[certificate]\nrequire = \"minimum\"\n";
  const Solution saddle = solved_column(column, 1.15171962 * column.critical_force(), nullptr, more);
  CHECK(saddle.certificate.verdict == Verdict::stalled);
  CHECK(contains(saddle.certificate.reason,
                 "[certificate] require = \"minimum\": it is an equilibrium, but second order says saddle (1 direction "
                 "of negative curvature, the most negative -"));
  CHECK(solved_column(column, 0.9 * column.critical_force(), nullptr, more).certificate.verdict == Verdict::converged);
  const Solution degenerate = solved_column(column, column.critical_force(), nullptr, more);
  CHECK(degenerate.certificate.verdict == Verdict::stalled);
  CHECK(contains(degenerate.certificate.reason, "second order says degenerate (1 direction without curvature: "));
}

TEST_CASE("away from an equilibrium nothing is judged, and that is said") {
  const SolvedScene limited = solved(session_of_text(contact_text(contact_scene(2), "max-iterations = 2")));
  const SecondOrder& second = limited.solution.certificate.second_order;
  CHECK(second.curvature == Curvature::unjudged);
  CHECK(second.reason == "the first-order conditions are not met");
  CHECK(curvature_name(second.curvature) == nullptr);
}

}  // namespace bowstring::testing
