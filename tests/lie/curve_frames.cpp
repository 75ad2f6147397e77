#include "core/lie/curve_frames.hpp"

#include "core/lie/s2.hpp"
#include "tests/lie/reference.hpp"

namespace bowstring::lie {
namespace {

/// A helix about +x with curvature κ and torsion τ, by arc length.
struct Helix {
  double curvature, torsion;

  double rate() const { return std::hypot(curvature, torsion); }
  Vector3 position(double s) const {
    const double k = rate(), radius = curvature / (k * k);
    return {{torsion / k * s, radius * std::cos(k * s), radius * std::sin(k * s)}};
  }
  /// Tangent, normal, binormal: the Frenet frame, whose body strain is the constant (τ, 0, κ; 1, 0, 0).
  Se3 frenet(double s) const {
    const double k = rate(), c = std::cos(k * s), sn = std::sin(k * s);
    const Vector3 tangent{{torsion / k, -curvature / k * sn, curvature / k * c}}, normal{{0.0, -c, -sn}};
    Matrix3 m;
    m.set_column(0, tangent);
    m.set_column(1, normal);
    m.set_column(2, cross(tangent, normal));
    return {from_matrix(m), position(s)};
  }
  std::vector<double> points(int nodes, double length) const {
    std::vector<double> out;
    for (int i = 0; i < nodes; ++i) {
      const Vector3 p = position(length * i / (nodes - 1));
      out.insert(out.end(), p.data.begin(), p.data.end());
    }
    return out;
  }
};

constexpr Helix helix{0.04, 0.03};
constexpr double length = 150.0;

std::vector<double> uneven_elements(int count) {
  reference::Numbers numbers(1);
  std::vector<double> ds;
  for (int i = 0; i < count; ++i) ds.push_back(2.0 + numbers.next());
  return ds;
}

TEST_CASE("Bishop frames of a helix are orthonormal, follow its edges and do not twist") {
  const std::vector<double> points = helix.points(200, length);
  const std::vector<Rotation> frames = bishop_edge_frames(points);
  REQUIRE(frames.size() == 199);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Matrix3 m = frames[i].matrix();
    CHECK(reference::relative_error(m.transpose() * m, reference::widen(Matrix3::identity())) < 2e-15);
    const double* p = points.data() + 3 * i;
    const Vector3 tangent = normalized(Vector3::load(p + 3) - Vector3::load(p));
    CHECK(norm(m.column(0) - tangent) < 1e-15);
    if (i == 0) continue;
    const Vector3 turn = log(frames[i - 1].inverse() * frames[i]);
    REQUIRE(norm(turn) > 0.01);
    CHECK(std::fabs(turn[0]) < 1e-15);
  }
}

/// Angle by which the last Bishop frame has turned about the tangent against the Frenet frame, with as many nodes.
double turn_against_frenet(int nodes) {
  const double half_edge = 0.5 * length / (nodes - 1);
  const auto angle = [](const Rotation& bishop, const Se3& frenet) {
    return log((frenet.rotation.inverse() * bishop))[0];
  };
  const Rotation first = transport(helix.frenet(half_edge).rotation, helix.frenet(half_edge).rotation.first_axis());
  const std::vector<Rotation> frames = bishop_edge_frames(helix.points(nodes, length), &first);
  return angle(frames.back(), helix.frenet(length - half_edge)) - angle(frames.front(), helix.frenet(half_edge));
}

TEST_CASE("Bishop frames turn against the Frenet frame by the integrated torsion, to second order") {
  // −∫τ ds between the middles of the first and the last edge, less a turn.
  const auto error = [](int nodes) {
    const double span = length * (1.0 - 1.0 / (nodes - 1));
    return turn_against_frenet(nodes) - (2.0 * reference::pi - helix.torsion * span);
  };
  const double coarse = std::fabs(error(51)), fine = std::fabs(error(101));
  REQUIRE(coarse > 1e-6);
  CHECK(fine < 3e-3);
  CHECK(coarse / fine == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("Bishop frames start from a given frame, and pass edges of length zero and reversals") {
  const std::vector<double> points{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 2, 0, 1, 1, 0};
  const Rotation first = exp(Vector3{{0.5, 0.0, 0.0}});
  const std::vector<Rotation> frames = bishop_edge_frames(points, &first);
  REQUIRE(frames.size() == 4);
  CHECK(norm(log(first.inverse() * frames[0])) < 1e-15);
  CHECK(frames[1].matrix() == frames[0].matrix());
  CHECK(norm(frames[2].first_axis() - Vector3{{0, 1, 0}}) < 1e-15);
  CHECK(norm(frames[3].first_axis() - Vector3{{0, -1, 0}}) < 1e-15);
  CHECK(bishop_edge_frames(std::vector<double>{0, 0, 0}).empty());
}

TEST_CASE("a constant strain reconstructs the closed-form helix") {
  const std::vector<double> ds = uneven_elements(75);
  const std::vector<se3::Twist> strains(ds.size(), {{helix.torsion, 0.0, helix.curvature, 1.0, 0.0, 0.0}});
  const std::vector<Se3> frames = reconstruct(helix.frenet(0.0), strains, ds);
  REQUIRE(frames.size() == ds.size() + 1);
  double s = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    CHECK(norm(frames[i].position - helix.position(s)) < 1e-13 * length);
    CHECK(norm(log(frames[i].rotation.inverse() * helix.frenet(s).rotation)) < 1e-13);
    if (i < ds.size()) s += ds[i];
  }
  CHECK(s > 100.0);
}

TEST_CASE("a constant strain reconstructs the closed-form circle in the plane") {
  const double radius = 25.0;
  const std::vector<double> ds = uneven_elements(75);
  const std::vector<se2::Twist> strains(ds.size(), {{1.0 / radius, 1.0, 0.0}});
  const std::vector<Se2> frames = reconstruct({0.0, {{0.0, -radius}}}, strains, ds);
  REQUIRE(frames.size() == ds.size() + 1);
  double s = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double angle = s / radius;
    CHECK(norm(frames[i].position - radius * Vector2{{std::sin(angle), -std::cos(angle)}}) < 1e-13 * length);
    if (i < ds.size()) s += ds[i];
  }
  CHECK(s > 100.0);
}

TEST_CASE("discrete strain recovers what a curve was reconstructed from, whatever its placement in space") {
  reference::Numbers numbers(2);
  const std::vector<double> ds = uneven_elements(20);
  std::vector<se3::Twist> strains;
  // An element of reference length ds and stretch ratio 1.2 has |ν| = 1.2.
  for (std::size_t i = 0; i < ds.size(); ++i) strains.push_back(se3::twist(numbers.vector<3>(), {{1.2, 0.1, 0.0}}));
  std::vector<Se3> frames = reconstruct(Se3::identity(), strains, ds);
  const Se3 placement{numbers.rotation(), 10.0 * numbers.vector<3>()};
  for (const bool placed : {false, true}) {
    if (placed) {
      for (Se3& g : frames) g = placement * g;
    }
    const std::vector<se3::Twist> found = discrete_strain(frames, ds);
    REQUIRE(found.size() == strains.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (norm(se3::angular(strains[i])) * ds[i] >= reference::pi) continue;
      CHECK(reference::relative_error(found[i], reference::widen(strains[i])) < 1e-13);
    }
  }
}

TEST_CASE("discrete strain in the plane recovers what a curve was reconstructed from") {
  reference::Numbers numbers(3);
  const std::vector<double> ds = uneven_elements(20);
  std::vector<se2::Twist> strains;
  for (std::size_t i = 0; i < ds.size(); ++i) strains.push_back({{numbers.next(), 1.2, 0.1 * numbers.next()}});
  const std::vector<se2::Twist> found = discrete_strain(reconstruct({0.3, {{4.0, -7.0}}}, strains, ds), ds);
  REQUIRE(found.size() == strains.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(reference::relative_error(found[i], reference::widen(strains[i])) < 1e-13);
  }
}

}  // namespace
}  // namespace bowstring::lie
