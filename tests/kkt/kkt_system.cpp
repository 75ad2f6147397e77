#include "core/kkt/kkt_system.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "core/kkt/local_elimination.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

using Dense = Eigen::MatrixXd;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A scene at a state far from any equilibrium, evaluated.
struct State {
  std::unique_ptr<Session> session;
  std::vector<double> jacobian, hessian;
  Dense w, j;
  std::vector<char> equality;

  Assembly& assembly() const { return *session->assembly; }
  int unknowns() const { return assembly().unknowns(); }
  int rows() const { return assembly().rows(); }
};

State state_of(const SmallScene& small, unsigned seed) {
  State out;
  out.session = session_of(small);
  Assembly& assembly = out.assembly();
  const std::vector<double> q = moved_start(*out.session, 0.3, seed);
  REQUIRE(assembly.accept(q).ok());
  const int n = out.unknowns(), m = out.rows();
  const SparsityPattern rows = assembly.jacobian_pattern(), pattern = assembly.hessian_pattern();
  out.jacobian.resize(at(rows.entries()));
  out.hessian.resize(at(pattern.entries()));
  ProblemEvaluation wanted;
  wanted.jacobian = out.jacobian;
  REQUIRE(assembly.evaluate(q, wanted).ok());
  REQUIRE(assembly.lagrangian_hessian(q, 1.0, random_numbers(m, seed + 20), out.hessian).ok());
  out.w = Dense::Zero(n, n);
  out.j = Dense::Zero(m, n);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.begin[at(c)]; k < pattern.begin[at(c) + 1]; ++k) {
      out.w(pattern.inner[at(k)], c) = out.w(c, pattern.inner[at(k)]) = out.hessian[at(k)];
    }
  }
  for (int r = 0; r < m; ++r) {
    out.equality.push_back(assembly.row_lower()[at(r)] == assembly.row_upper()[at(r)] ? 1 : 0);
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) out.j(r, rows.inner[at(k)]) = out.jacobian[at(k)];
  }
  return out;
}

SmallScene scene_of(int dimension, const char* kinematics, const char* contact, bool frames) {
  SmallScene small;
  small.dimension = dimension;
  small.vessel_kinematics = small.wire_kinematics = kinematics;
  small.contact_type = contact;
  small.vessel_frames = frames;
  return small;
}

/// What `act` is to be done with: both kinematics, in the plane and in space, node-wise and segment-wise.
template <class Act>
void for_states(const Act& act) {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const char* contact : {"node-wise-contact", "segment-wise-contact"}) {
        for (const bool frames : {false, true}) {
          if (frames && dimension == 2) continue;
          for (unsigned seed = 1; seed <= 2; ++seed) {
            CAPTURE(dimension);
            CAPTURE(std::string(kinematics));
            CAPTURE(std::string(contact));
            CAPTURE(frames);
            CAPTURE(seed);
            act(state_of(scene_of(dimension, kinematics, contact, frames), seed));
          }
        }
      }
    }
  }
}

/// Negative eigenvalues of W + Σ JᵀJ/e on the null space of the exact rows.
int dense_saddle_directions(const State& state, const Dense& w, const std::vector<double>& softness,
                            const std::vector<char>& held) {
  Dense condensed = w;
  std::vector<int> exact;
  for (int r = 0; r < state.rows(); ++r) {
    if (state.equality[at(r)] != 0 || (!held.empty() && held[at(r)] != 0)) {
      exact.push_back(r);
    } else if (std::isfinite(softness[at(r)])) {
      condensed += state.j.row(r).transpose() * state.j.row(r) / softness[at(r)];
    }
  }
  Dense rows(static_cast<Eigen::Index>(exact.size()), state.unknowns());
  for (std::size_t k = 0; k < exact.size(); ++k) {
    rows.row(static_cast<Eigen::Index>(k)) = state.j.row(exact[k]).normalized();
  }
  const Dense null = rows.fullPivLu().kernel();
  const Dense orthogonal = null.householderQr().householderQ() * Dense::Identity(null.rows(), null.cols());
  const Eigen::SelfAdjointEigenSolver<Dense> eigen(orthogonal.transpose() * condensed * orthogonal);
  return static_cast<int>((eigen.eigenvalues().array() < 0.0).count());
}

/// W with a shift of what is not eliminated where it stands, as KktSystem documents it.
Dense shifted(const State& state, double shift) {
  Dense w = state.w;
  kkt::LocalElimination local;
  local.analyse(state.assembly(), state.jacobian);
  for (int u = 0; u < state.unknowns(); ++u) {
    const double scale = state.assembly().stationarity_scale()[at(u)];
    if (local.block_of_unknown(u) < 0) w(u, u) += shift * scale * scale;
  }
  return w;
}

struct Solved {
  Eigen::VectorXd delta, lambda;
};

Solved dense_solution(const State& state, const Dense& w, const std::vector<double>& softness,
                      const std::vector<char>& held, const std::vector<double>& a, const std::vector<double>& b) {
  const int n = state.unknowns(), m = state.rows();
  Dense k = Dense::Zero(n + m, n + m);
  Eigen::VectorXd right(n + m);
  k.topLeftCorner(n, n) = w;
  for (int u = 0; u < n; ++u) right[u] = a[at(u)];
  for (int r = 0; r < m; ++r) {
    const bool exact = state.equality[at(r)] != 0 || (!held.empty() && held[at(r)] != 0);
    const bool off = !exact && !std::isfinite(softness[at(r)]);
    right[n + r] = off ? 0.0 : b[at(r)];
    k(n + r, n + r) = off ? 1.0 : exact ? 0.0 : -softness[at(r)];
    if (off) continue;
    k.row(n + r).head(n) = state.j.row(r);
    k.col(n + r).head(n) = state.j.row(r).transpose();
  }
  const Eigen::VectorXd x = k.fullPivLu().solve(right);
  return {x.head(n), x.tail(m)};
}

double relative(const std::vector<double>& found, const Eigen::VectorXd& expected) {
  REQUIRE(expected.size() > 0);
  REQUIRE(expected.cwiseAbs().maxCoeff() > 1e-6);
  const Eigen::Map<const Eigen::VectorXd> x(found.data(), expected.size());
  return (x - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a place's own unknowns and rows are eliminated as the linear algebra of the place says") {
  int blocks = 0;
  for_states([&](const State& state) {
    kkt::LocalElimination local;
    local.analyse(state.assembly(), state.jacobian);
    CHECK(local.fits(state.assembly()));
    REQUIRE(local.update(state.jacobian));
    for (const kkt::LocalBlock& block : local.blocks()) {
      ++blocks;
      const int d = block.rows, k = block.locals, p = block.retained;
      Dense jd(d, k), jp(d, p);
      for (int i = 0; i < d; ++i) {
        CHECK(local.block_of_row(block.first_row + i) == static_cast<int>(&block - local.blocks().data()));
        for (int l = 0; l < k; ++l) jd(i, l) = state.j(block.first_row + i, local.local(block)[l]);
        for (int c = 0; c < p; ++c) jp(i, c) = state.j(block.first_row + i, local.retained(block)[c]);
      }
      for (int l = 0; l < k; ++l) {
        CHECK(local.place_in_block(local.local(block)[l]) == l);
        // No other row reads it.
        for (int r = 0; r < state.rows(); ++r) {
          const bool own = r >= block.first_row && r < block.first_row + d;
          if (!own && state.equality[at(r)] != 0) CHECK(state.j(r, local.local(block)[l]) == 0.0);
        }
      }
      // J_D δ_D + J_P δ_P = b: for every δ_P with B δ_P = what is left, δ_D = rotated − A δ_P solves all rows.
      const std::vector<double> b = random_numbers(d, 3), free = random_numbers(p, 4);
      std::vector<double> rotated = b;
      local.rotate(block, rotated.data());
      Eigen::VectorXd dp = Eigen::Map<const Eigen::VectorXd>(free.data(), p);
      if (block.left() > 0) {
        const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows(
            local.b(block), block.left(), p);
        const Eigen::Map<const Eigen::VectorXd> left(rotated.data() + k, block.left());
        dp += rows.transpose() * (rows * rows.transpose()).fullPivLu().solve(left - rows * dp);
      }
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> a(local.a(block),
                                                                                                       k, p);
      const Eigen::VectorXd dd = Eigen::Map<const Eigen::VectorXd>(rotated.data(), k) - a * dp;
      const Eigen::VectorXd off = jd * dd + jp * dp - Eigen::Map<const Eigen::VectorXd>(b.data(), d);
      CHECK(off.cwiseAbs().maxCoeff() <= 1e-11);
      // J_Dᵀ λ = pull, and Bᵀ stands for what is left: Qᵀλ's second part.
      const std::vector<double> pull = random_numbers(k, 6), remaining = random_numbers(4, 7);
      std::vector<double> lambda(at(d));
      local.multipliers(block, pull.data(), remaining.data(), lambda.data());
      const Eigen::VectorXd held = jd.transpose() * Eigen::Map<const Eigen::VectorXd>(lambda.data(), d);
      for (int l = 0; l < k; ++l) CHECK(held[l] == doctest::Approx(pull[at(l)]).epsilon(1e-11));
    }
  });
  REQUIRE(blocks > 100);
}

TEST_CASE("an elimination that no longer moves its rows says so") {
  const State state = state_of(scene_of(2, "edge-frames", "node-wise-contact", false), 1);
  kkt::LocalElimination local;
  local.analyse(state.assembly(), state.jacobian);
  REQUIRE_FALSE(local.blocks().empty());
  std::vector<double> dead = state.jacobian;
  const kkt::LocalBlock& block = local.blocks().front();
  const SparsityPattern pattern = state.assembly().jacobian_pattern();
  for (int r = block.first_row; r < block.first_row + block.rows; ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      if (pattern.inner[at(k)] == local.local(block)[0]) dead[at(k)] = 0.0;
    }
  }
  CHECK_FALSE(local.update(dead));
  CHECK(local.update(state.jacobian));
  const State other = state_of(scene_of(2, "edge-frames", "node-wise-contact", false), 1);
  CHECK_FALSE(local.fits(other.assembly()));
}

TEST_CASE("the system is that of dense algebra: softness over ten decades, rows held and off, a shift") {
  int held_rows = 0, off_rows = 0, bordered = 0;
  for_states([&](const State& state) {
    const int n = state.unknowns(), m = state.rows();
    bordered += state.assembly().border();
    const std::vector<double> exponent = random_numbers(m, 31);
    std::vector<double> softness(at(m), 1.0);
    std::vector<char> held(at(m), 0);
    for (int r = 0; r < m; ++r) {
      if (state.equality[at(r)] != 0) continue;
      softness[at(r)] = std::pow(10.0, -3.0 + 5.0 * exponent[at(r)]);  // 1e-8 … 1e2 mm/N
      if (r % 4 == 1) softness[at(r)] = infinity, ++off_rows;
      if (r % 5 == 2) held[at(r)] = 1, ++held_rows;
    }
    for (const std::vector<char>& marks : {std::vector<char>(), held}) {
      // Enough of a shift that W is positive: solutions are then well defined.
      const double shift = 1e3;
      const Dense w = shifted(state, shift);
      kkt::KktSystem system;
      system.analyse(state.assembly(), state.jacobian, marks);
      kkt::KktSystem::Values values;
      values.hessian = state.hessian;
      values.jacobian = state.jacobian;
      values.softness = softness;
      values.shift = shift;
      const kkt::KktSystem::Outcome outcome = system.factor(values);
      REQUIRE(outcome.exists);
      CHECK(outcome.saddle_directions == dense_saddle_directions(state, w, softness, marks));
      const std::vector<double> a = random_numbers(n, 33), b = random_numbers(m, 34);
      std::vector<double> delta(at(n)), lambda(at(m));
      const double left = system.solve(a, b, {}, 10, delta, lambda);
      CHECK(left <= 1e-9);
      const Solved expected = dense_solution(state, w, softness, marks, a, b);
      CHECK(relative(delta, expected.delta) <= 1e-6);
      CHECK(relative(lambda, expected.lambda) <= 1e-6);
      for (int r = 0; r < m; ++r) {
        const bool exact = state.equality[at(r)] != 0 || (!marks.empty() && marks[at(r)] != 0);
        if (!exact && !std::isfinite(softness[at(r)])) CHECK(lambda[at(r)] == 0.0);
      }
    }
  });
  REQUIRE(held_rows > 20);
  REQUIRE(off_rows > 20);
  REQUIRE(bordered > 0);
}

TEST_CASE("inertia without a shift: the negative directions that dense algebra finds") {
  int saddles = 0, all = 0;
  for_states([&](const State& state) {
    std::vector<double> softness(at(state.rows()), infinity);
    for (int r = 0; r < state.rows(); ++r) {
      if (state.equality[at(r)] == 0 && r % 2 == 0) softness[at(r)] = 0.1;
    }
    kkt::KktSystem system;
    system.analyse(state.assembly(), state.jacobian);
    kkt::KktSystem::Values values;
    values.hessian = state.hessian;
    values.jacobian = state.jacobian;
    values.softness = softness;
    const kkt::KktSystem::Outcome outcome = system.factor(values);
    REQUIRE(outcome.exists);
    const int expected = dense_saddle_directions(state, state.w, softness, {});
    CHECK(outcome.saddle_directions == expected);
    saddles += expected > 0 ? 1 : 0;
    ++all;
  });
  REQUIRE(saddles > 2);
  REQUIRE(all > saddles);
}

TEST_CASE("rows that an answer gives way to less than the factors do: refinement brings the answer to its own") {
  const State state = state_of(scene_of(2, "edge-frames", "node-wise-contact", false), 2);
  const int n = state.unknowns(), m = state.rows();
  std::vector<double> softness(at(m), 1e-2), exactness(at(m), 5e-3);
  const double shift = 1e3;
  kkt::KktSystem system;
  system.analyse(state.assembly(), state.jacobian);
  kkt::KktSystem::Values values;
  values.hessian = state.hessian;
  values.jacobian = state.jacobian;
  values.softness = softness;
  values.shift = shift;
  REQUIRE(system.factor(values).exists);
  const std::vector<double> a = random_numbers(n, 33), b = random_numbers(m, 34);
  std::vector<double> delta(at(n)), lambda(at(m));
  const double left = system.solve(a, b, exactness, 60, delta, lambda);
  CHECK(left <= 1e-9);
  const Solved expected = dense_solution(state, shifted(state, shift), exactness, {}, a, b);
  CHECK(relative(delta, expected.delta) <= 1e-7);
  CHECK(relative(lambda, expected.lambda) <= 1e-7);
}

}  // namespace bowstring::testing
