#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/energies/terms.hpp"

namespace bowstring::testing {

namespace {

/// The scene with another vessel foundation.
std::string with_foundation(const SmallScene& scene, const std::string& type, const std::string& stiffness) {
  std::string text = scene.text();
  const std::string old = "type = \"anchoring\"\non = \"vessel\"\nstiffness = \"0.05 N/mm^2\"\n";
  const std::size_t where = text.find(old);
  REQUIRE(where != std::string::npos);
  return text.replace(where, old.size(), "type = \"" + type + "\"\non = \"vessel\"\nstiffness = " + stiffness + "\n");
}

std::string exact(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", number);
  return text;
}

/// Half the lengths of the adjacent edges.
std::vector<double> tributary_lengths(const Curve& curve) {
  const int n = curve.view.nodes;
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    const double before = i > 0 ? curve.view.edge_length[i - 1] : 0.0;
    const double after = i + 1 < n ? curve.view.edge_length[i] : 0.0;
    out.push_back(0.5 * (before + after));
  }
  return out;
}

std::vector<double> gradient(const Session& session, const std::vector<double>& q) {
  std::vector<double> out(at(session.assembly->unknowns()));
  ProblemEvaluation evaluation;
  evaluation.gradient = out;
  const Status status = session.assembly->evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

bool mentions(const std::vector<std::string>& texts, const std::string& first, const std::string& second = "") {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
    return text.find(first) != std::string::npos && text.find(second) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("a foundation per length is the one per node whose springs are stiffness times tributary length") {
  const auto stiffness = [](double s) { return 0.05 + 0.002 * s; };  // N/mm²
  for (const char* type : {"anchoring", "extravascular"}) {
    for (const int dimension : {2, 3}) {
      for (const char* kinematics : {"nodes", "edge-frames"}) {
        CAPTURE(std::string(type));
        CAPTURE(dimension);
        CAPTURE(std::string(kinematics));
        SmallScene scene;
        scene.dimension = dimension;
        scene.vessel_kinematics = kinematics;
        scene.vessel_ends = R"(["free", "free"])";  // so that half edges count
        if (dimension == 2) {
          scene.geometry =
              "{ type = \"sinusoid\", chord = \"40 mm\", amplitude = \"4 mm\", periods = 1, nodes = 8, "
              "sampling = \"uniform-x\" }";
        }
        const auto plain = session_of_text(with_foundation(scene, type, "\"0.05 N/mm^2\""));
        const Curve& vessel = *plain->scene->find("vessel");
        const std::vector<double> tributary = tributary_lengths(vessel);
        std::string per_node, per_length, per_node_constant;
        for (int i = 0; i < vessel.view.nodes; ++i) {
          const std::string s = "[\"" + exact(vessel.arc[at(i)]) + " mm\", \"";
          const double k = stiffness(vessel.arc[at(i)]);
          per_length += (i > 0 ? ", " : "") + s + exact(k) + " N/mm^2\"]";
          per_node += (i > 0 ? ", " : "") + s + exact(k * tributary[at(i)]) + " N/mm\"]";
          per_node_constant += (i > 0 ? ", " : "") + s + exact(0.05 * tributary[at(i)]) + " N/mm\"]";
        }
        const auto table = [](const std::string& rows) { return "{ table = [" + rows + "] }"; };
        const auto varying = session_of_text(with_foundation(scene, type, table(per_length)));
        const auto springs = session_of_text(with_foundation(scene, type, table(per_node)));
        const auto equal_springs = session_of_text(with_foundation(scene, type, table(per_node_constant)));

        const std::vector<double> q = moved_start(*plain, 0.4, 31);
        const auto same = [&](const Session& a, const Session& b) {
          const std::vector<double> energy_a = term_energies(a, q), energy_b = term_energies(b, q);
          const std::size_t term = at(static_cast<int>(&energy_of(a, type) - a.scene->energies.data()));
          REQUIRE(energy_a[term] > 1e-3);
          CHECK(std::fabs(energy_a[term] - energy_b[term]) <= 1e-12 * energy_a[term]);
          const std::vector<double> g = gradient(a, q);
          REQUIRE(largest(g) > 1e-3);
          CHECK(largest_difference(g, gradient(b, q)) <= 1e-12 * largest(g));
        };
        same(*plain, *equal_springs);
        same(*varying, *springs);
        CHECK(std::fabs(term_energies(*plain, q)[2] - term_energies(*varying, q)[2]) > 1e-3);
      }
    }
  }
}

TEST_CASE("springs per node stiffen with the mesh, a stiffness per length does not") {
  // A uniform shift of a straight vessel by u costs ½ k L u² per length and ½ k n u² per node.
  for (const bool per_node : {false, true}) {
    for (const int nodes : {8, 15}) {
      SmallScene scene;
      scene.geometry = "{ type = \"line\", length = \"40 mm\", nodes = " + std::to_string(nodes) + " }";
      scene.vessel_ends = R"(["free", "free"])";
      const auto session =
          session_of_text(with_foundation(scene, "anchoring", per_node ? "\"0.3 N/mm\"" : "\"0.05 N/mm^2\""));
      std::vector<double> q = session->scene->start_coordinates();
      const Curve& vessel = *session->scene->find("vessel");
      for (int i = 0; i < nodes; ++i) q[at(vessel.coordinate_begin + 2 * i + 1)] += 0.7;
      const double expected = 0.5 * 0.49 * (per_node ? 0.3 * nodes : 0.05 * 40.0);
      CHECK(term_energies(*session, q)[2] == doctest::Approx(expected).epsilon(1e-12));
    }
  }
}

TEST_CASE("vessel-strain warns, with figures, where nothing resists stretching, in space also torsion") {
  const auto warnings = [](int dimension, const std::string& stretch, const std::string& torsion) {
    SmallScene scene;
    scene.dimension = dimension;
    std::string text = scene.text();
    const std::string old = "stretch-stiffness = \"11 N\"\n";
    const std::size_t where = text.find(old);
    REQUIRE(where != std::string::npos);
    text.replace(where, old.size(),
                 (stretch.empty() ? "" : "stretch-stiffness = " + stretch + "\n") +
                     (torsion.empty() ? "" : "torsional-stiffness = " + torsion + "\n"));
    return session_of_text(text)->scene->warnings;
  };
  const std::string stretch = "stretch-stiffness is 0", torsion = "torsional-stiffness is 0";
  const std::string zeros = R"({ table = [["0 mm", 0], ["20 mm", 0]] })";
  const std::string partly = R"({ table = [["0 mm", 0], ["20 mm", 5]] })";
  for (const std::string& none : {std::string(), std::string("\"0 N\""), zeros}) {
    CAPTURE(none);
    CHECK(mentions(warnings(2, none, ""), stretch, "vessel 'vessel'"));
    CHECK(mentions(warnings(2, none, ""), "10.55 mm against 9.75 mm"));
    CHECK(mentions(warnings(3, none, "\"9 N mm^2\""), stretch));
  }
  for (const std::string& some : {std::string("\"11 N\""), partly}) {
    CAPTURE(some);
    CHECK_FALSE(mentions(warnings(2, some, ""), stretch));
    CHECK_FALSE(mentions(warnings(3, some, ""), stretch));
  }
  for (const std::string& none : {std::string(), std::string("\"0 N mm^2\""), zeros}) {
    CAPTURE(none);
    CHECK(mentions(warnings(3, "\"11 N\"", none), torsion, "vessel 'vessel'"));
    CHECK(mentions(warnings(3, "\"11 N\"", none), "0.07 N mm against 2.69"));
    CHECK_FALSE(mentions(warnings(2, "\"11 N\"", none), torsion));
  }
  for (const std::string& some : {std::string("\"9 N mm^2\""), partly}) {
    CAPTURE(some);
    CHECK_FALSE(mentions(warnings(3, "\"11 N\"", some), torsion));
  }
}

TEST_CASE("torsional stiffness is idle in the plane") {
  SmallScene scene;
  std::string text = scene.text();
  text.insert(text.find("[[energy]]\ntype = \"anchoring\""), "torsional-stiffness = \"9 N mm^2\"\n");
  const auto session = session_of_text(text);
  REQUIRE(session->scene->without_effect.size() == 1);
  CHECK(mentions(session->scene->without_effect, "'torsional-stiffness' of energy 'vessel-strain' has no effect",
                 "a curve in the plane does not twist"));
}

TEST_CASE("a foundation per length is refused on a wire that slides; axial tension warns on a wire that does not") {
  SmallScene scene;
  std::string text = scene.text();
  const std::string foundation = "[[energy]]\ntype = \"extravascular\"\non = \"wire\"\nstiffness = \"0.04 N/mm^2\"\n";
  text.insert(text.find("[solver]"), foundation);
  const std::string refusal = refusal_of(text);
  CHECK(refusal.find("energy 'extravascular' on 'wire'") != std::string::npos);
  CHECK(refusal.find("put it on the vessel") != std::string::npos);
  CHECK_FALSE(mentions(session_of(scene)->scene->warnings, "axial-tension has no effect"));

  scene.wire_ends = R"(["clamped", "free"])";
  CHECK(mentions(session_of(scene)->scene->warnings, "axial-tension has no effect on 'wire'"));
}

}  // namespace bowstring::testing
