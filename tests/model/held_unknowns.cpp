#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/model/manifold.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// "position 0", "orientation 5", …: entries of a curve that no unknown moves.
std::set<std::string> held_entries(const Session& session, const std::string& name) {
  const Curve& curve = *session.scene->find(name);
  std::set<std::string> out;
  std::size_t entry = 0;
  for (const auto& other : session.scene->curves) {
    for (const FieldDeclaration& field : other->declaration.fields) {
      for (int i = 0; i < field.count; ++i, ++entry) {
        if (other->name != curve.name || session.assembly->entries()[entry].block >= 0) continue;
        out.insert(field.name + " " + std::to_string(i));
      }
    }
  }
  return out;
}

struct Ends {
  std::string wire_ends;
  std::set<std::string> positions, others;  ///< held entries of a wire with seven nodes
};

using Entries = std::set<std::string>;

SmallScene on_arc(const std::string& radius) {
  SmallScene scene;
  scene.geometry = R"({ type = "arc", radius = "20 mm", angle = "90 deg", nodes = 40 })";
  scene.radius = radius;
  return scene;
}

struct Evaluated {
  double energy = 0.0;
  std::vector<double> gradient, rows, jacobian;
};

Evaluated evaluated(Assembly& assembly, const std::vector<double>& q) {
  Evaluated out;
  out.gradient.resize(at(assembly.unknowns()));
  out.rows.resize(at(assembly.rows()));
  std::vector<double> jacobian(at(assembly.jacobian_pattern().entries()));
  ProblemEvaluation evaluation;
  evaluation.energy = &out.energy;
  evaluation.gradient = out.gradient;
  evaluation.rows = out.rows;
  evaluation.jacobian = jacobian;
  const Status status = assembly.evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  out.jacobian = dense_rows(assembly.jacobian_pattern(), jacobian, assembly.rows(), assembly.unknowns());
  return out;
}

}  // namespace

TEST_CASE("ends eliminate their own entries, which no step moves") {
  const Ends cases[] = {
      {R"(["pinned", "pinned"])", {"position 0", "position 6"}, {}},
      {R"(["clamped", "pinned"])", {"position 0", "position 6"}, {"held-tangent 0"}},
      {R"(["clamped", "clamped"])", {"position 0", "position 6"}, {"held-tangent 0", "held-tangent 1"}},
      {R"(["held-edge", "pinned"])", {"position 0", "position 1", "position 6"}, {"orientation 0"}},
      {R"(["pinned", "held-edge"])", {"position 0", "position 5", "position 6"}, {"orientation 5"}},
      {R"(["clamped", "free"])", {"position 0"}, {"held-tangent 0"}},
      {R"(["free", "pinned"])", {"position 6"}, {}}};
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const Ends& ends : cases) {
        CAPTURE(dimension);
        CAPTURE(std::string(kinematics));
        CAPTURE(ends.wire_ends);
        SmallScene scene;
        scene.dimension = dimension;
        scene.wire_kinematics = kinematics;
        scene.wire_ends = ends.wire_ends;
        const auto session = session_of(scene);
        Entries expected = ends.positions;
        for (const std::string& entry : ends.others) {
          const bool exists = std::string(kinematics) == "edge-frames" || !contains(entry, "orientation");
          if (exists) expected.insert(entry);
        }
        CHECK(held_entries(*session, "wire") == expected);

        const Assembly& assembly = *session->assembly;
        const std::vector<double> start = session->scene->start_coordinates();
        std::vector<double> q(start.size());
        assembly.retract(start, std::vector<double>(at(assembly.unknowns()), 0.1), q);
        int moved = 0;
        for (const FieldEntry& entry : assembly.entries()) {
          const auto first = start.begin() + entry.coordinate;
          const bool same = std::equal(first, first + coordinate_count(entry.manifold, entry.dimension),
                                       q.begin() + entry.coordinate);
          CHECK(same == (entry.block < 0));
          moved += same ? 0 : 1;
        }
        CHECK(moved > 0);
      }
    }
  }
}

TEST_CASE("a vessel's held edge keeps its length too") {
  SmallScene scene;
  scene.vessel_ends = R"(["held-edge", "pinned"])";
  CHECK(held_entries(*session_of(scene), "vessel") ==
        Entries{"position 0", "position 1", "position 7", "orientation 0", "edge-length 0"});
}

TEST_CASE("a wire starts on the curve through its vessel's nodes, evenly along it") {
  // 40 nodes of an arc leave a spline that is a circle to 1e-4 mm.
  SmallScene scene = on_arc("\"3 mm\"");
  scene.wire_nodes = 23;
  const auto session = session_of(scene);
  const Curve& vessel = *session->scene->find("vessel");
  const Curve& wire = *session->scene->find("wire");
  // The centre from three of the vessel's nodes.
  const double* p = vessel.reference.data();
  const double *a = p, *b = p + 2 * 20, *c = p + 2 * 39;
  const double d = 2.0 * (a[0] * (b[1] - c[1]) + b[0] * (c[1] - a[1]) + c[0] * (a[1] - b[1]));
  const auto squared = [](const double* x) { return x[0] * x[0] + x[1] * x[1]; };
  const double centre[2] = {(squared(a) * (b[1] - c[1]) + squared(b) * (c[1] - a[1]) + squared(c) * (a[1] - b[1])) / d,
                            (squared(a) * (c[0] - b[0]) + squared(b) * (a[0] - c[0]) + squared(c) * (b[0] - a[0])) / d};
  const double angle = std::acos(-1.0) / 2.0;
  for (int i = 0; i < wire.view.nodes; ++i) {
    const double x = wire.start[at(2 * i)] - centre[0], y = wire.start[at(2 * i + 1)] - centre[1];
    CHECK(std::hypot(x, y) == doctest::Approx(20.0).epsilon(1e-5));
    const double from_first = std::fabs(
        std::atan2((a[0] - centre[0]) * y - (a[1] - centre[1]) * x, (a[0] - centre[0]) * x + (a[1] - centre[1]) * y));
    CHECK(std::fabs(from_first - angle * i / (wire.view.nodes - 1)) < 1e-4);
  }
}

TEST_CASE("a tube that folds is refused from R κ = 0.8 on, with its place, its bend and how to mend it") {
  CHECK(session_of(on_arc("\"15.5 mm\"")) != nullptr);
  // Wide enough to fold only near s = 20 mm.
  const std::string text =
      refusal_of(on_arc(R"({ table = [["15 mm", "4 mm"], ["20 mm", "17 mm"], ["25 mm", "4 mm"]] })").text());
  REQUIRE(contains(text, "the tube of vessel 'vessel' folds into itself at s = "));
  const auto number_after = [&](const std::string& what) {
    const std::size_t where = text.find(what);
    REQUIRE(where != std::string::npos);
    return std::stod(text.substr(where + what.size()));
  };
  const double place = number_after("folds into itself at s = ");
  CHECK(std::fabs(place - 20.0) < 1.0);
  const double radius = number_after("(radius ");
  CHECK(radius > 16.0);
  CHECK(number_after("bend radius ") == doctest::Approx(20.0).epsilon(0.01));
  CHECK(number_after("radius times curvature is ") == doctest::Approx(radius / 20.0).epsilon(0.01));
  CHECK(contains(text, "expected less than 0.8 everywhere"));
  CHECK(contains(text, "'smoothing'"));
  CHECK(contains(refusal_of(on_arc("\"16.5 mm\"").text()), "folds into itself"));
}

TEST_CASE("a wire wider than the lumen is refused where that is worst") {
  SmallScene scene = on_arc(R"({ table = [["5 mm", "3 mm"], ["12 mm", "0.25 mm"], ["19 mm", "3 mm"]] })");
  scene.wire_nodes = 40;
  const std::string text = refusal_of(scene.text());
  REQUIRE(contains(text, "wire 'wire' (radius 0.4 mm) is as wide as the lumen of 'vessel' or wider, by "));
  const double excess = std::stod(text.substr(text.find("wider, by ") + 10));
  const double place = std::stod(text.substr(text.find(" mm at s = ") + 11));
  CHECK(std::fabs(place - 12.0) < 0.8);
  CHECK(excess > 0.0);
  CHECK(excess <= 0.15);
  CHECK(contains(text, "reduce the wire's radius, or use type = \"concentric\", which has no clearance"));
}

TEST_CASE("'measured-from' is refused where there is no tip or sheath") {
  const std::string tip = R"({ table = [["0 mm", "3 mm"]], measured-from = "tip" })";
  CHECK(contains(refusal_of(on_arc(tip).text()),
                 "'measured-from' in 'radius' of vessel 'vessel'; expected it on a wire only"));
  CHECK(contains(refusal_of(on_arc(R"({ column = "radius_mm", measured-from = "tip" })").text()),
                 "without a 'table'; expected it beside arc lengths only"));
}

TEST_CASE("a profile from the tip runs backwards along a wire") {
  SmallScene scene;
  scene.wire_ends = R"(["clamped", "free"])";
  const auto stiffness = [&](const std::string& origin) {
    std::string text = scene.text();
    const std::string old = "\"65 N mm^2\"";
    text.replace(text.find(old), old.size(),
                 R"({ table = [["0 mm", "10 N mm^2"], ["10 mm", "60 N mm^2"]])" + origin + " }");
    const auto session = session_of_text(text);
    const Curve& wire = *session->scene->find("wire");
    const auto& stations = *wire.site(Site::station);
    const std::vector<double>& sampled = session->scene->energies.front().laws.front().parameters.front();
    REQUIRE(sampled.size() == stations.arc.size());
    REQUIRE(wire.arc.back() > 20.0);
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      const double s = origin.empty() ? stations.arc[i] : wire.arc.back() - stations.arc[i];
      CHECK(sampled[i] == doctest::Approx(10.0 + 5.0 * std::min(s, 10.0)).epsilon(1e-12));
    }
    return sampled;
  };
  CHECK(stiffness("").front() < 60.0);
  CHECK(stiffness(", measured-from = \"tip\"").back() < 60.0);
}

TEST_CASE("the guard refuses whatever is asked for, and infinity switches it off") {
  SmallScene scene;
  scene.wire_kinematics = scene.vessel_kinematics = "nodes";
  const auto session = session_of(scene);
  Assembly& assembly = *session->assembly;
  std::vector<double> q = session->scene->start_coordinates();
  q[at(session->scene->find("wire")->coordinate_begin + 2 * 3 + 1)] += 2.5;
  double energy = 0.0;
  std::vector<double> gradient(at(assembly.unknowns())), rows(at(assembly.rows()));
  std::vector<double> jacobian(at(assembly.jacobian_pattern().entries()));
  ProblemEvaluation wanted[4];
  wanted[0].energy = &energy;
  wanted[1].gradient = gradient;
  wanted[2].rows = rows;
  wanted[3].jacobian = jacobian;
  for (const double guard : {0.5, std::numeric_limits<double>::infinity()}) {
    assembly.set_guard(guard);
    for (const ProblemEvaluation& one : wanted) {
      // Another state in between, so that no answer is one kept from before.
      REQUIRE(assembly.evaluate(session->scene->start_coordinates(), one).ok());
      CHECK(assembly.evaluate(q, one).code == (std::isfinite(guard) ? Code::refused : Code::ok));
    }
  }
}

TEST_CASE("an epoch changes patterns, and no number") {
  SmallScene scene;
  scene.geometry = R"({ type = "line", length = "40 mm", nodes = 21 })";
  scene.wire_nodes = 9;
  scene.wire_kinematics = scene.vessel_kinematics = "nodes";
  std::string text = scene.text();
  text.replace(text.find("window = 20"), 11, "window = 2");
  const auto session = session_of_text(text);
  Assembly& assembly = *session->assembly;
  std::vector<double> q = session->scene->start_coordinates();
  const Curve& wire = *session->scene->find("wire");
  q[at(wire.coordinate_begin + 2 * 4)] += 5.3;  // beyond the next wire node, near the window's edge
  q[at(wire.coordinate_begin + 2 * 4 + 1)] += 0.9;
  REQUIRE(assembly.accept(q).ok());
  REQUIRE(assembly.epoch_due());
  const std::vector<int> before(assembly.jacobian_pattern().inner.begin(), assembly.jacobian_pattern().inner.end());
  const Evaluated old = evaluated(assembly, q);
  REQUIRE(assembly.new_epoch().ok());
  CHECK(assembly.epochs() == 2);
  const std::vector<int> after(assembly.jacobian_pattern().inner.begin(), assembly.jacobian_pattern().inner.end());
  CHECK(before != after);
  const Evaluated rebound = evaluated(assembly, q);
  CHECK(rebound.energy == old.energy);
  CHECK(rebound.gradient == old.gradient);
  REQUIRE(rebound.rows.size() == old.rows.size());
  CHECK(largest_difference(rebound.rows, old.rows) <= 1e-12);
  REQUIRE(largest(old.jacobian) > 0.1);
  CHECK(largest_difference(rebound.jacobian, old.jacobian) <= 1e-12);
  check_derivatives(tangent_problem(assembly, q));
}

}  // namespace bowstring::testing
