#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/certificate/multipliers.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr double everything = 1e300;  // mm: every row is within that reach of its bound

/// The least-squares problem min |target − A λ| with λ_r ≥ 0 where `is_signed`, in N.
struct LeastSquares {
  Eigen::MatrixXd a;
  Eigen::VectorXd target;
  std::vector<bool> is_signed;

  double residual(const Eigen::VectorXd& multipliers) const { return (target - a * multipliers).norm(); }
};

LeastSquares least_squares(Assembly& assembly, const std::vector<double>& q) {
  const int n = assembly.unknowns();
  const int m = assembly.rows();
  const SparsityPattern pattern = assembly.jacobian_pattern();
  std::vector<double> gradient(at(n)), jacobian(at(pattern.entries()));
  ProblemEvaluation evaluation;
  evaluation.gradient = gradient;
  evaluation.jacobian = jacobian;
  const Status status = assembly.evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  const std::vector<double> rows = dense_rows(pattern, jacobian, m, n);
  LeastSquares out;
  out.a.resize(n, m);
  out.target.resize(n);
  for (int u = 0; u < n; ++u) {
    const double scale = assembly.stationarity_scale()[at(u)];
    out.target[u] = -gradient[at(u)] / scale;
    for (int r = 0; r < m; ++r) out.a(u, r) = rows[at(r * n + u)] / scale;
  }
  for (int r = 0; r < m; ++r) out.is_signed.push_back(assembly.row_lower()[at(r)] != assembly.row_upper()[at(r)]);
  return out;
}

/// Minimiser with the chosen columns alone, the other multipliers zero.
Eigen::VectorXd solve_with(const LeastSquares& problem, const std::vector<int>& chosen) {
  Eigen::MatrixXd columns(problem.a.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t c = 0; c < chosen.size(); ++c) columns.col(static_cast<Eigen::Index>(c)) = problem.a.col(chosen[c]);
  const Eigen::VectorXd solution = columns.completeOrthogonalDecomposition().solve(problem.target);
  Eigen::VectorXd full = Eigen::VectorXd::Zero(problem.a.cols());
  for (std::size_t c = 0; c < chosen.size(); ++c) full[chosen[c]] = solution[static_cast<Eigen::Index>(c)];
  return full;
}

/// Tries every set of signed rows that may carry a multiplier.
Eigen::VectorXd enumerated(const LeastSquares& problem) {
  const int m = static_cast<int>(problem.a.cols());
  std::vector<int> place(at(m), -1);
  int signed_rows = 0;
  for (int r = 0; r < m; ++r) {
    if (problem.is_signed[at(r)]) place[at(r)] = signed_rows++;
  }
  REQUIRE(signed_rows > 0);
  REQUIRE(signed_rows <= 12);
  Eigen::VectorXd best = Eigen::VectorXd::Zero(m);
  double smallest = std::numeric_limits<double>::infinity();
  for (unsigned set = 0; set < 1u << signed_rows; ++set) {
    std::vector<int> chosen;
    for (int r = 0; r < m; ++r) {
      if (place[at(r)] < 0 || (set >> place[at(r)] & 1u) != 0u) chosen.push_back(r);
    }
    const Eigen::VectorXd multipliers = solve_with(problem, chosen);
    const bool admissible = std::all_of(chosen.begin(), chosen.end(),
                                        [&](int r) { return !problem.is_signed[at(r)] || multipliers[r] >= 0.0; });
    const double residual = problem.residual(multipliers);
    if (admissible && residual < smallest) smallest = residual, best = multipliers;
  }
  return best;
}

std::vector<double> estimated(Assembly& assembly, const std::vector<double>& q, double reach) {
  std::vector<double> out;
  const Status status = estimate_multipliers(assembly, q, reach, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  REQUIRE(out.size() == at(assembly.rows()));
  return out;
}

Eigen::VectorXd vector_of(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

double largest(const Eigen::VectorXd& numbers) { return numbers.lpNorm<Eigen::Infinity>(); }

SmallScene nodes_scene() {
  SmallScene scene;
  scene.vessel_kinematics = scene.wire_kinematics = "nodes";
  return scene;
}

}  // namespace

TEST_CASE("estimated multipliers of random states are those of every set of active rows tried in turn") {
  int carrying = 0, idle = 0;
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      SmallScene scene;
      scene.dimension = dimension;
      scene.vessel_kinematics = scene.wire_kinematics = kinematics;
      scene.wire_nodes = 9;
      const auto session = session_of(scene);
      Assembly& assembly = *session->assembly;
      for (unsigned seed = 1; seed <= 10; ++seed) {
        CAPTURE(dimension);
        CAPTURE(std::string(kinematics));
        CAPTURE(seed);
        const std::vector<double> q = moved_start(*session, 0.8, seed);
        const LeastSquares problem = least_squares(assembly, q);
        REQUIRE(problem.target.norm() > 1.0);
        const Eigen::VectorXd expected = enumerated(problem);
        REQUIRE(largest(expected) > 1e-2);
        const std::vector<double> found = estimated(assembly, q, everything);
        CHECK(largest(vector_of(found) - expected) <= 1e-8 * largest(expected));
        CHECK(problem.residual(vector_of(found)) <= problem.residual(expected) * (1.0 + 1e-12));
        for (int r = 0; r < assembly.rows(); ++r) {
          if (!problem.is_signed[at(r)]) continue;
          CHECK(found[at(r)] >= 0.0);
          (found[at(r)] > 0.0 ? carrying : idle) += 1;
        }
      }
    }
  }
  CHECK(carrying > 50);
  CHECK(idle > 50);
}

TEST_CASE("rows that say the same twice share their multiplier: the residual is still the smallest") {
  std::string text = nodes_scene().text();
  text.insert(text.find("[solver]"),
              "[[constraint]]\nname = \"lumen-again\"\ntype = \"node-wise-contact\"\non = [\"wire\", \"vessel\"]\n"
              "window = 20\ncenterline = \"spline\"\n");
  const auto session = session_of_text(text);
  Assembly& assembly = *session->assembly;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const std::vector<double> q = moved_start(*session, 0.8, seed);
    const LeastSquares problem = least_squares(assembly, q);
    const Eigen::VectorXd expected = enumerated(problem);
    REQUIRE(largest(expected) > 1e-2);
    const std::vector<double> found = estimated(assembly, q, everything);
    for (int r = 0; r < assembly.rows(); ++r) {
      if (problem.is_signed[at(r)]) CHECK(found[at(r)] >= 0.0);
    }
    CHECK(problem.residual(vector_of(found)) <= problem.residual(expected) * (1.0 + 1e-10));
  }
}

TEST_CASE("rows farther from their bound than the reach carry nothing") {
  const auto session = session_of(nodes_scene());
  Assembly& assembly = *session->assembly;
  const std::vector<double> q = moved_start(*session, 0.8, 3);
  std::vector<double> residual(at(assembly.rows()));
  ProblemEvaluation evaluation;
  evaluation.rows = residual;
  REQUIRE(assembly.evaluate(q, evaluation).ok());
  const RowOrigin rows = contact_rows(assembly);
  std::vector<double> gaps(residual.begin() + rows.first, residual.begin() + rows.first + rows.count);
  std::sort(gaps.begin(), gaps.end());
  const double reach = -0.5 * (gaps[gaps.size() / 2] + gaps[gaps.size() / 2 - 1]);
  REQUIRE(reach > 0.0);
  LeastSquares problem = least_squares(assembly, q);
  int beyond = 0;
  for (int r = rows.first; r < rows.first + rows.count; ++r) {
    if (residual[at(r)] >= -reach) continue;
    problem.a.col(r).setZero();
    ++beyond;
  }
  REQUIRE(beyond > 0);
  REQUIRE(beyond < rows.count);
  const Eigen::VectorXd expected = enumerated(problem);
  const std::vector<double> found = estimated(assembly, q, reach);
  for (int r = rows.first; r < rows.first + rows.count; ++r) {
    if (residual[at(r)] < -reach) CHECK(found[at(r)] == 0.0);
  }
  CHECK(largest(vector_of(found) - expected) <= 1e-8 * largest(expected));
}

}  // namespace bowstring::testing
