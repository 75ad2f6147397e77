#include "kinematics/edge-frames/edge_frames.hpp"
#include "kinematics/nodes/nodes.hpp"
#include "tests/kinematics/differences.hpp"

namespace {

using namespace bowstring;
using namespace bowstring::testing;

enum class Ends { free, clamped, held_edge_and_clamp };

struct Case {
  int dimension;
  bool material_frames;
  Extension extension;
  Ends ends;

  std::string text() const {
    const char* extensions[] = {"sliding", "fixed", "stretching"};
    const char* end_names[] = {"free ends", "clamped ends", "held edge and clamp"};
    return std::to_string(dimension) + "-D, " + (material_frames ? "material frames, " : "") +
           extensions[static_cast<int>(extension)] + ", " + end_names[static_cast<int>(ends)];
  }
  Needs needs() const {
    Needs needs;
    needs.material_frames = material_frames;
    needs.reason = "a test reads the twist";
    return needs;
  }
  TestCurve dressed(TestCurve curve) const {
    curve.extension = extension;
    const std::vector<double> first = {1.0, 0.4, dimension == 3 ? 0.3 : 0.0},
                              last = {0.7, 0.9, dimension == 3 ? -0.2 : 0.0};
    if (ends == Ends::clamped) curve.clamp(0, first);
    if (ends == Ends::held_edge_and_clamp) curve.hold_edge(0);
    if (ends != Ends::free) curve.clamp(1, last);
    return curve;
  }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Extension extension : {Extension::sliding, Extension::fixed, Extension::stretching}) {
    for (const Ends ends : {Ends::free, Ends::clamped, Ends::held_edge_and_clamp}) {
      cases.push_back({2, false, extension, ends});
      cases.push_back({3, false, extension, ends});
      cases.push_back({3, true, extension, ends});
    }
  }
  return cases;
}

/// Edges that double back on themselves: each turns by `turn` against the one before, about an axis of its own.
TestCurve zigzag(int dimension, int nodes, double turn, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  TestCurve curve;
  curve.dimension = dimension;
  Vector3 point = Vector3::zero(), direction = {{0.8, 0.6, 0.0}};
  for (int i = 0; i < nodes; ++i) {
    for (int k = 0; k < dimension; ++k) curve.reference.push_back(point[k]);
    point += (2.5 + 0.3 * uniform(random)) * direction;
    Vector3 axis = {{0.0, 0.0, uniform(random) < 0.0 ? -1.0 : 1.0}};
    if (dimension == 3) {
      const Vector3 any = {{uniform(random), uniform(random), uniform(random)}};
      axis = normalized(cross(direction, any));
    }
    direction = lie::exp(turn * axis) * direction;
  }
  return curve;
}

template <class Declared>
std::vector<double> perturbed(const Declared& curve, double size, unsigned seed) {
  std::vector<double> delta = random_numbers(curve.unknowns(), seed);
  for (double& x : delta) x *= size;
  return curve.retract(curve.start(), delta);
}

/// Every site that is declared. `bases_are_coordinates`: ζ's basis is carried by the coordinates, so that its numbers
/// can be compared one by one; otherwise only |ζ| has a meaning.
template <class Declared>
void check_all_sites(const Declared& curve, const std::vector<double>& q, bool bases_are_coordinates,
                     Tolerance tolerance = {}) {
  for (const SiteDeclaration& site : curve.declaration.sites) {
    CAPTURE(static_cast<int>(site.site));
    const bool frames_in_space = site.site == Site::frame && curve.curve.dimension == 3;
    const bool own_basis = site.site == Site::station && !bases_are_coordinates;
    if (!frames_in_space && !own_basis) check_site(curve, site.site, q, tolerance);
  }
  check_isotropic_energy(curve, q, tolerance);
}

template <class SomeKinematics>
void check_state(const Case& c, const TestCurve& shape, double perturbation, Tolerance tolerance = {}) {
  CAPTURE(c.text());
  const DeclaredCurve<SomeKinematics> curve(c.dressed(shape), c.needs());
  const bool bases_are_coordinates = c.dimension == 2 || std::is_same_v<SomeKinematics, EdgeFrames>;
  check_all_sites(curve, perturbed(curve, perturbation, 11), bases_are_coordinates, tolerance);
}

TEST_CASE("B and curvature of edge-frames at random states") {
  for (const Case& c : all_cases()) check_state<EdgeFrames>(c, crooked_curve(c.dimension, 6, 3), 0.2);
}

TEST_CASE("B and curvature of nodes at random states") {
  for (const Case& c : all_cases()) {
    if (!c.material_frames) check_state<Nodes>(c, crooked_curve(c.dimension, 6, 5), 0.2);
  }
}

TEST_CASE("B and curvature of edge-frames at nearly straight states") {
  for (const Case& c : all_cases()) check_state<EdgeFrames>(c, straight_curve(c.dimension, 6, 12.0), 1e-8);
}

TEST_CASE("B and curvature of nodes at nearly straight states") {
  for (const Case& c : all_cases()) {
    if (!c.material_frames) check_state<Nodes>(c, straight_curve(c.dimension, 6, 12.0), 1e-8);
  }
}

TEST_CASE("B and curvature of edge-frames where edges double back") {
  for (const Case& c : all_cases()) {
    check_state<EdgeFrames>(c, zigzag(c.dimension, 6, M_PI - 0.05, 9), 1e-3, {1e-8, 1e-7});
    // A direction's derivatives grow like 1/sin of the turn, a rotation's stay bounded up to a half turn.
    if (c.dimension == 2 || c.material_frames) check_state<EdgeFrames>(c, zigzag(c.dimension, 6, M_PI - 1e-3, 9), 1e-6);
  }
}

TEST_CASE("B and curvature of nodes where edges double back") {
  for (const Case& c : all_cases()) {
    if (!c.material_frames) check_state<Nodes>(c, zigzag(c.dimension, 6, M_PI - 0.05, 9), 1e-3, {1e-8, 1e-7});
  }
}

TEST_CASE("a frame's tangent numbers are those of the orientation field") {
  for (const int dimension : {2, 3}) {
    for (const bool material_frames : {false, true}) {
      const Case c{dimension, material_frames, Extension::stretching, Ends::free};
      const DeclaredCurve<EdgeFrames> curve(c.dressed(crooked_curve(dimension, 5, 3)), c.needs());
      const SiteDeclaration& site = curve.site(Site::frame);
      CHECK(site.identity);
      CHECK(site.values == site.width);
      const std::vector<double> b = curve.jacobian(Site::frame, curve.start());
      const int position_numbers = dimension * 5;
      for (int r = 0; r < site.count * site.values; ++r) {
        for (int u = 0; u < curve.unknowns(); ++u) {
          CHECK(b[at(r * curve.unknowns() + u)] == (u == position_numbers + r ? 1.0 : 0.0));
        }
      }
    }
  }
}

}  // namespace
