#include <doctest/doctest.h>

#include <cmath>

#include "core/model/manifold.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct NamedScene {
  std::string name;
  SmallScene scene;
};

SmallScene planar(const char* vessel, const char* wire) {
  SmallScene scene;
  scene.vessel_kinematics = vessel;
  scene.wire_kinematics = wire;
  return scene;
}

SmallScene spatial(const char* vessel, const char* wire) {
  SmallScene scene = planar(vessel, wire);
  scene.dimension = 3;
  return scene;
}

const char* const polyline = R"(centerline = "polyline")";

/// Every kinematics, end, interpolation and frame, in the plane and in space.
std::vector<NamedScene> scenes() {
  std::vector<NamedScene> out;
  out.push_back({"plane: nodes, pinned, spline", planar("nodes", "nodes")});
  out.push_back({"plane: edge-frames, clamped, spline", planar("edge-frames", "edge-frames")});
  out.back().scene.vessel_ends = R"(["clamped", "pinned"])";
  out.back().scene.wire_ends = R"(["pinned", "clamped"])";
  out.push_back({"plane: edge-frames, held edge, polyline", planar("edge-frames", "edge-frames")});
  out.back().scene.wire_ends = R"(["held-edge", "pinned"])";
  out.back().scene.contact = polyline;
  out.push_back({"plane: nodes, clamped and held edge, polyline", planar("nodes", "nodes")});
  out.back().scene.vessel_ends = R"(["pinned", "held-edge"])";
  out.back().scene.wire_ends = R"(["clamped", "held-edge"])";
  out.back().scene.contact = polyline;
  out.push_back({"plane: nodes around edge-frames with a free tip", planar("nodes", "edge-frames")});
  out.back().scene.wire_ends = R"(["clamped", "free"])";
  out.back().scene.vessel_ends = R"(["clamped", "free"])";

  out.push_back({"space: nodes, pinned, spline", spatial("nodes", "nodes")});
  out.push_back({"space: nodes, clamped and held edge, polyline", spatial("nodes", "nodes")});
  out.back().scene.wire_ends = R"(["clamped", "held-edge"])";
  out.back().scene.contact = polyline;
  out.push_back({"space: edge-frames without material frames, clamped", spatial("edge-frames", "edge-frames")});
  out.back().scene.vessel_ends = R"(["clamped", "pinned"])";
  out.back().scene.wire_ends = R"(["clamped", "pinned"])";
  out.push_back({"space: material frames on the vessel, held edge", spatial("edge-frames", "edge-frames")});
  out.back().scene.vessel_frames = true;
  out.back().scene.wire_ends = R"(["held-edge", "clamped"])";
  out.push_back({"space: material frames on both, clamped, polyline", spatial("edge-frames", "edge-frames")});
  out.back().scene.vessel_frames = out.back().scene.wire_frames = true;
  out.back().scene.vessel_ends = R"(["clamped", "held-edge"])";
  out.back().scene.wire_ends = R"(["clamped", "pinned"])";
  out.back().scene.contact = polyline;
  out.push_back({"space: nodes with angles on both, clamped", spatial("nodes", "nodes")});
  out.back().scene.vessel_frames = out.back().scene.wire_frames = true;
  out.back().scene.vessel_ends = R"(["clamped", "held-edge"])";
  out.back().scene.wire_ends = R"(["held-edge", "clamped"])";
  for (const bool space : {false, true}) {
    const std::string where = space ? "space: " : "plane: ";
    const SmallScene scene = space ? spatial("nodes", "edge-frames") : planar("edge-frames", "nodes");
    for (const char* type : {"segment-wise-contact", "same-index-contact", "concentric"}) {
      out.push_back({where + type, scene});
      out.back().scene.contact_type = type;
      out.back().scene.wire_nodes = std::string(type) == "same-index-contact" ? 8 : 7;
      out.back().scene.wire_ends = R"(["clamped", "free"])";
    }
    out.push_back({where + "three rows per segment", scene});
    out.back().scene.contact = "rows-per-segment = 3";
    out.push_back({where + "outside", scene});
    out.back().scene.contact = "side = \"outside\"";
  }
  out.push_back({"space: frames around nodes with a free tip", spatial("edge-frames", "nodes")});
  out.back().scene.vessel_frames = true;
  out.back().scene.wire_ends = R"(["clamped", "free"])";
  return out;
}

/// The same scenes along a straight line, whose rest curvature vanishes.
SmallScene straightened(SmallScene scene) {
  scene.geometry = R"({ type = "line", length = "40 mm", nodes = 8 })";
  return scene;
}

/// A state that is straight to 1e-8 and yet under load: nodes are shifted along the line (the first axis), lengths too.
std::vector<double> nearly_straight(const Session& session, unsigned seed) {
  const Assembly& assembly = *session.assembly;
  std::vector<double> delta = random_numbers(assembly.unknowns(), seed);
  for (const FieldEntry& entry : assembly.entries()) {
    for (int k = 0; k < tangent_count(entry.manifold, entry.dimension); ++k) {
      const int u = assembly.free_of_unknown()[at(entry.unknown + k)];
      if (u < 0) continue;
      const bool along = entry.manifold == Manifold::real || (entry.manifold == Manifold::vector && k == 0);
      delta[at(u)] *= along ? 0.3 : 1e-8;
    }
  }
  std::vector<double> q = session.scene->start_coordinates();
  assembly.retract(q, delta, q);
  return q;
}

/// Orientations such that neighbouring edges differ by `turn`, about axes that are random in space. Positions stay, so
/// that closure rows are large and smooth.
std::vector<double> turned(const Session& session, double turn, unsigned seed) {
  std::vector<double> q = session.scene->start_coordinates();
  const std::vector<double> numbers = random_numbers(3 * session.assembly->unknowns(), seed);
  const double* next = numbers.data();
  const double* previous = nullptr;
  for (const FieldEntry& entry : session.assembly->entries()) {
    const bool rotational = is_curved(entry.manifold) || entry.manifold == Manifold::circle;
    if (!rotational || entry.block < 0) {
      previous = nullptr;
      continue;
    }
    double* own = q.data() + entry.coordinate;
    if (previous != nullptr) {
      const int count = tangent_count(entry.manifold, entry.dimension);
      double delta[3], squared = 0.0;
      for (int k = 0; k < count; ++k) delta[k] = *next++, squared += delta[k] * delta[k];
      for (int k = 0; k < count; ++k) delta[k] *= turn / std::sqrt(squared);
      retract(entry.manifold, entry.dimension, previous, delta, own);
    }
    previous = own;
  }
  return q;
}

std::vector<double> chart_point(const Session& session, EuclideanProblem& chart, double amplitude, unsigned seed) {
  std::vector<double> x(at(session.assembly->unknowns()));
  chart.start(x);
  const std::vector<double> delta = random_numbers(session.assembly->unknowns(), seed);
  for (const FieldEntry& entry : session.assembly->entries()) {
    if (entry.block < 0) continue;
    const double scale = is_curved(entry.manifold) ? amplitude : 0.3 * amplitude;
    for (int u = session.assembly->blocks().begin[at(entry.block)];
         u < session.assembly->blocks().begin[at(entry.block) + 1]; ++u) {
      x[at(u)] += scale * delta[at(u)];
    }
  }
  return x;
}

}  // namespace

TEST_CASE("gradient, Jacobian and Lagrangian Hessian are those of differences along the retraction: random states") {
  for (const NamedScene& named : scenes()) {
    CAPTURE(named.name);
    const auto session = session_of(named.scene);
    check_derivatives(tangent_problem(*session->assembly, moved_start(*session, 0.3, 5)));
  }
}

TEST_CASE("gradient, Jacobian and Lagrangian Hessian are those of differences: every form of the gap") {
  for (const char* gap : {"squared", "distance", "smooth-distance"}) {
    for (const int dimension : {2, 3}) {
      CAPTURE(std::string(gap));
      CAPTURE(dimension);
      SmallScene scene = dimension == 2 ? planar("nodes", "edge-frames") : spatial("nodes", "edge-frames");
      scene.contact = std::string("gap = \"") + gap + "\"";
      const auto session = session_of(scene);
      std::vector<double> q = moved_start(*session, 0.3, 11);
      // A distance is singular on the centerline: the wire stands a millimetre aside.
      const Curve& wire = *session->scene->find("wire");
      for (int i = 1; i + 1 < wire.view.nodes; ++i) q[at(wire.coordinate_begin + i * dimension + 1)] += 1.5;
      check_derivatives(tangent_problem(*session->assembly, q));
    }
  }
}

TEST_CASE("gradient, Jacobian and Lagrangian Hessian are those of differences: nearly straight states") {
  for (const NamedScene& named : scenes()) {
    CAPTURE(named.name);
    const auto session = session_of(straightened(named.scene));
    check_derivatives(tangent_problem(*session->assembly, nearly_straight(*session, 6)));
  }
}

TEST_CASE("gradient, Jacobian and Lagrangian Hessian are those of differences: turning angles near pi") {
  constexpr double near_pi = 3.0915926535897931;
  for (NamedScene& named : scenes()) {
    if (named.scene.vessel_kinematics == "nodes" || named.scene.wire_kinematics == "nodes") continue;
    CAPTURE(named.name);
    const auto session = session_of(named.scene);
    check_derivatives(tangent_problem(*session->assembly, turned(*session, near_pi, 7)), {5e-5, 4e-4}, {1e-7, 1e-5});
  }
}

TEST_CASE(
    "gradient, Jacobian and Lagrangian Hessian are those of differences: a wire of nodes that turns back by nearly "
    "pi") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    SmallScene scene = dimension == 2 ? planar("nodes", "nodes") : spatial("nodes", "nodes");
    scene.contact = "";
    const auto session = session_of(scene);
    std::vector<double> q = session->scene->start_coordinates();
    // Every second edge is turned back by 3.09 rad against the one before it.
    for (const auto& curve : session->scene->curves) {
      double* p = q.data() + curve->coordinate_begin;
      for (int i = 2; i + 1 < curve->view.nodes; ++i) {
        double edge[3] = {}, length = 0.0;
        for (int k = 0; k < dimension; ++k) edge[k] = p[(i - 1) * dimension + k] - p[(i - 2) * dimension + k];
        for (const double e : edge) length += e * e;
        length = std::sqrt(length);
        const double sideways = (i % 2 == 0 ? 0.05 : -0.05) * length;
        for (int k = 0; k < dimension; ++k) p[i * dimension + k] = p[(i - 1) * dimension + k] - 0.9 * edge[k];
        p[i * dimension] += -sideways * edge[1] / std::hypot(edge[0], edge[1]);
        p[i * dimension + 1] += sideways * edge[0] / std::hypot(edge[0], edge[1]);
      }
    }
    check_derivatives(tangent_problem(*session->assembly, q), {2e-4, 2e-3}, {1e-6, 1e-4});
  }
}

TEST_CASE("a chart's gradient, Jacobian and Hessian are plain partial derivatives: at its base, near it, and far") {
  for (const NamedScene& named : scenes()) {
    CAPTURE(named.name);
    const auto session = session_of(named.scene);
    const auto chart = session->assembly->chart(moved_start(*session, 0.2, 8));
    for (const double amplitude : {0.0, 1e-8, 0.5}) {
      CAPTURE(amplitude);
      check_derivatives(chart_problem(*session->assembly, *chart, chart_point(*session, *chart, amplitude, 9)));
    }
  }
}

TEST_CASE("a chart's derivatives stay right where a block has turned by nearly pi from its base") {
  for (const bool frames : {false, true}) {
    CAPTURE(frames);
    SmallScene scene = spatial("edge-frames", "edge-frames");
    scene.vessel_frames = frames;
    scene.wire_ends = R"(["clamped", "pinned"])";
    const auto session = session_of(scene);
    const auto chart = session->assembly->chart(session->scene->start_coordinates());
    std::vector<double> x(at(session->assembly->unknowns()));
    chart->start(x);
    const std::vector<double> numbers = random_numbers(session->assembly->unknowns(), 10);
    std::vector<double> axis;
    for (const FieldEntry& entry : session->assembly->entries()) {
      if (entry.block < 0 || !is_curved(entry.manifold)) continue;
      // All blocks turn about nearly one axis, so that neighbours stay near each other.
      const int first = session->assembly->blocks().begin[at(entry.block)];
      const int count = session->assembly->blocks().size(entry.block);
      const double base[3] = {0.6, -1.0, 1.0};
      double squared = 0.0;
      for (int k = 0; k < count; ++k) {
        x[at(first + k)] = base[3 - count + k] + 0.1 * numbers[at(first + k)];
        squared += x[at(first + k)] * x[at(first + k)];
      }
      for (int k = 0; k < count; ++k) x[at(first + k)] *= 3.09 / std::sqrt(squared);
    }
    CHECK(chart->recentre_due(x));
    check_derivatives(chart_problem(*session->assembly, *chart, x), {1e-4, 1e-3}, {1e-7, 1e-5});
  }
}

}  // namespace bowstring::testing
