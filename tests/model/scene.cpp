#include <doctest/doctest.h>

#include <cmath>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

SmallScene with_ends(int dimension, const std::string& first, const std::string& last) {
  SmallScene scene;
  scene.dimension = dimension;
  scene.wire_ends = "[\"" + first + "\", \"" + last + "\"]";
  return scene;
}

}  // namespace

TEST_CASE("a wire held at both ends slides; with a free end its length is fixed") {
  CHECK(session_of(with_ends(2, "pinned", "pinned"))->scene->find("wire")->view.extension == Extension::sliding);
  CHECK(session_of(with_ends(2, "pinned", "free"))->scene->find("wire")->view.extension == Extension::fixed);
}

TEST_CASE("a rigid vessel has no unknowns and its walls stay") {
  SmallScene scene;
  const auto session =
      session_of_text(edited(scene.text(), "kinematics = \"edge-frames\"\nends", "rigid = true\nends"));
  const Curve& vessel = *session->scene->find("vessel");
  for (const FieldEntry& entry : session->assembly->entries()) {
    if (entry.unknown < vessel.unknown_begin + vessel.unknowns) CHECK(entry.block == -1);
  }
  const Solution solution = solve(*session, nullptr);
  CHECK(solution.certificate.verdict == Verdict::converged);
  for (int i = 0; i < vessel.view.nodes * 2; ++i) {
    CHECK(solution.q[at(vessel.coordinate_begin + i)] == vessel.reference[at(i)]);
  }
}

TEST_CASE("fields exist only where something asks for them") {
  const auto field_names = [](const Session& session, const std::string& curve) {
    std::string out;
    for (const FieldDeclaration& field : session.scene->find(curve)->declaration.fields) out += field.name + " ";
    return out;
  };
  SmallScene scene;
  CHECK(field_names(*session_of(scene), "vessel") == "position orientation edge-length ");
  CHECK(field_names(*session_of(scene), "wire") == "position orientation length ");
  scene.wire_kinematics = scene.vessel_kinematics = "nodes";
  CHECK(field_names(*session_of(scene), "vessel") == "position ");
  CHECK(field_names(*session_of(scene), "wire") == "position length ");
  scene.wire_ends = R"(["clamped", "free"])";
  CHECK(field_names(*session_of(scene), "wire") == "position held-tangent ");
}

TEST_CASE("radii are judged only where a constraint reads them") {
  SmallScene scene;
  scene.radius = "\"50 mm\"";  // a tube that folds into itself
  CHECK(refusal_of(scene.text()).find("folds into itself at s = ") != std::string::npos);
  scene.radius = "\"0.3 mm\"";
  CHECK(refusal_of(scene.text()).find("is as wide as the lumen of 'vessel' or wider") != std::string::npos);
  scene.contact = "";
  CHECK(session_of(scene) != nullptr);
  scene.radius = "\"50 mm\"";
  CHECK(session_of(scene) != nullptr);
}

TEST_CASE("a profile along a sliding wire is refused with the reason") {
  CHECK(refusal_of(edited(SmallScene{}.text(), "\"65 N mm^2\"",
                          "{ table = [[\"0 mm\", \"65 N mm^2\"], [\"20 mm\", \"30 N mm^2\"]] }"))
            .find("'bending-stiffness' of energy 'wire-bending' varies along 'wire', whose length slides; expected one "
                  "value along a sliding wire") != std::string::npos);
  CHECK(refusal_of(edited(SmallScene{}.text(), "radius = \"0.4 mm\"",
                          "radius = { table = [[\"0 mm\", \"0.4 mm\"], [\"20 mm\", \"0.9 mm\"]] }"))
            .find("'radius' varies along 'wire', whose length slides; expected one value along a sliding wire; give a "
                  "value, or let the wire end inside the vessel") != std::string::npos);
}

TEST_CASE("two runs in one process give the same bits") {
  for (const char* file : {"planar-iliac-smooth.toml", "helical-iliac-full.toml"}) {
    std::vector<double> first_q, first_multipliers;
    for (int run = 0; run < 2; ++run) {
      const auto session = session_of_file(file, {{"vessel.iliac.geometry.nodes", "40"}});
      const Solution solution = solve(*session, nullptr);
      REQUIRE(solution.certificate.verdict == Verdict::converged);
      if (run == 0) {
        first_q = solution.q;
        first_multipliers = solution.multipliers;
      }
      CHECK(solution.q == first_q);
      CHECK(solution.multipliers == first_multipliers);
    }
  }
}

}  // namespace bowstring::testing
