#include <doctest/doctest.h>

#include <cmath>

#include "core/curve/arc_length.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// small_scene's text with more lines in the table of the wire.
std::string with_wire(const SmallScene& scene, const std::string& lines) {
  return edited(scene.text(), "radius = \"0.4 mm\"\n", "radius = \"0.4 mm\"\n" + lines);
}

const Curve& curve(const Session& session, const std::string& name) { return *session.scene->find(name); }

}  // namespace

TEST_CASE("a span starts the wire on its part of the vessel, and its rows there") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    SmallScene scene;
    scene.dimension = dimension;
    scene.wire_ends = R"(["clamped", "free"])";
    const auto session = session_of_text(with_wire(scene, "span = [\"10 mm\", \"25 mm\"]\n"));
    const Curve& wire = curve(*session, "wire");
    const Curve& vessel = curve(*session, "vessel");
    CHECK(wire.view.extension == Extension::fixed);
    CHECK(wire.arc.back() == doctest::Approx(15.0).epsilon(0.01));
    // The vessel has 8 nodes; its polyline and the curve through them part by a few per mille.
    const int d = dimension;
    for (const int node : {0, wire.view.nodes - 1}) {
      const double arc = node == 0 ? 10.0 : 25.0;
      double squared = 0.0;
      for (int k = 0; k < d; ++k) {
        std::vector<double> coordinate;
        for (int i = 0; i < vessel.view.nodes; ++i) coordinate.push_back(vessel.reference[at(i * d + k)]);
        const double on_edge = interpolate_linearly(vessel.arc, coordinate, arc);
        squared += std::pow(wire.reference[at(node * d + k)] - on_edge, 2);
      }
      CHECK(std::sqrt(squared) < 0.8);
    }
    for (int e = 0; e < 2; ++e) {
      const int from = e == 0 ? 0 : wire.view.nodes - 2;
      double along = 0.0;
      for (int k = 0; k < d; ++k) {
        along += wire.view.end[e].tangent[k] * (wire.start[at((from + 1) * d + k)] - wire.start[at(from * d + k)]);
      }
      CHECK(along == doctest::Approx(wire.view.edge_length[from]).epsilon(0.05));
    }
    std::vector<RowReport> reports;
    REQUIRE(session->assembly->report(session->scene->start_coordinates(), 0, reports).ok());
    REQUIRE(reports.size() == static_cast<std::size_t>(wire.view.nodes - 1));
    CHECK(reports.back().wire_coordinate == wire.view.nodes - 1);  // the free tip has a row
    CHECK(reports.back().gap < -0.4);
  }
}

TEST_CASE("a span beyond the vessel is refused with its length") {
  const std::string text = refusal_of(with_wire(SmallScene{}, "span = [0, 400]\n"));
  CHECK(text.find("'span' of wire 'wire' ends at 400 mm; expected at most the length of vessel 'vessel', ") !=
        std::string::npos);
  CHECK(text.find("; shorten the span, or leave it out for all of the vessel") != std::string::npos);
}

TEST_CASE("spacing grades the wire: its edges keep their shares of the length") {
  SmallScene scene;
  scene.wire_nodes = 5;
  const std::vector<double> share = {0.1, 0.2, 0.3, 0.4};
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    scene.wire_kinematics = kinematics;
    const auto session = session_of_text(with_wire(scene, "spacing = [0.1, 0.2, 0.3, 0.4]\n"));
    const Curve& wire = curve(*session, "wire");
    for (int i = 0; i < 4; ++i) {
      CHECK(wire.fraction[at(i)] == doctest::Approx(share[at(i)]).epsilon(1e-14));
      CHECK(wire.edge_length[at(i)] / wire.arc.back() == doctest::Approx(share[at(i)]).epsilon(0.02));
    }
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    const double* p = solution.q.data() + wire.coordinate_begin;
    std::vector<double> arc = polyline_arc({p, p + 10}, 2);
    for (int i = 0; i < 4; ++i) CHECK((arc[at(i + 1)] - arc[at(i)]) / arc.back() == doctest::Approx(share[at(i)]));
  }
}

TEST_CASE("a spacing of another number of edges is refused") {
  const std::string text = refusal_of(with_wire(SmallScene{}, "spacing = [0.5, 0.5]\n"));
  CHECK(text.find("'spacing' of wire 'wire' has 2 entries; expected one for each of its 6 edges; write 6 numbers, or "
                  "change its nodes") != std::string::npos);
}

TEST_CASE("several wires and vessels stand in one scene, and rows couple named pairs") {
  SmallScene scene;
  const std::string one = scene.text();
  std::string second = one.substr(one.find("[[vessel]]"));
  second = second.substr(0, second.find("[solver]"));
  for (const auto& [from, to] : {std::pair{"\"vessel\"", "\"second vessel\""},
                                 {"\"wire\"", "\"second wire\""},
                                 {"name = \"lumen\"", "name = \"second lumen\""}}) {
    for (std::size_t i = second.find(from); i != std::string::npos; i = second.find(from, i + std::string(to).size())) {
      second.replace(i, std::string(from).size(), to);
    }
  }
  for (const char* type : {"wire-bending", "vessel-strain", "anchoring", "axial-tension"}) {
    const std::string key = std::string("type = \"") + type + "\"\n";
    second.replace(second.find(key), key.size(), key + "name = \"second " + type + "\"\n");
  }
  std::string both = one;
  both.insert(both.find("[solver]"), second);

  const auto alone = session_of_text(one);
  const Solution single = solve(*alone, nullptr);
  const auto together = session_of_text(both);
  const Solution pair = solve(*together, nullptr);
  REQUIRE(single.certificate.verdict == Verdict::converged);
  REQUIRE(pair.certificate.verdict == Verdict::converged);
  CHECK(together->assembly->unknowns() == 2 * alone->assembly->unknowns());
  CHECK(together->assembly->rows() == 2 * alone->assembly->rows());
  std::vector<double> energies, twice;
  REQUIRE(alone->assembly->term_energies(single.q, energies).ok());
  REQUIRE(together->assembly->term_energies(pair.q, twice).ok());
  double sum = 0.0, of_both = 0.0;
  for (const double energy : energies) sum += energy;
  for (const double energy : twice) of_both += energy;
  REQUIRE(sum > 1e-3);
  CHECK(of_both == doctest::Approx(2.0 * sum).epsilon(1e-9));
}

}  // namespace bowstring::testing
