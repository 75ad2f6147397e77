#include <doctest/doctest.h>

#include <cmath>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

Code trial(Assembly& assembly, const std::vector<double>& q) {
  double energy = 0.0;
  ProblemEvaluation evaluation;
  evaluation.energy = &energy;
  return assembly.evaluate(q, evaluation).code;
}

/// A straight vessel of clearance 2.6 mm with a wire of nodes alone, so that one number moves one node.
SmallScene straight() {
  SmallScene scene;
  scene.geometry = R"({ type = "line", length = "40 mm", nodes = 9 })";
  scene.radius = "\"3 mm\"";
  scene.wire_nodes = 9;
  scene.wire_kinematics = scene.vessel_kinematics = "nodes";
  return scene;
}

std::vector<double> with_node(const Session& session, const std::string& curve, int node, double along, double across) {
  std::vector<double> q = session.scene->start_coordinates();
  const int begin = session.scene->find(curve)->coordinate_begin + 2 * node;
  q[at(begin)] += along;
  q[at(begin + 1)] += across;
  return q;
}

}  // namespace

TEST_CASE("the guard refuses a step of a wire node across its wall by more than half the clearance") {
  const auto session = session_of(straight());
  Assembly& assembly = *session->assembly;
  const std::vector<double> far = with_node(*session, "wire", 4, 0.0, 1.4),
                            near = with_node(*session, "wire", 4, 0.0, 1.2);
  CHECK(trial(assembly, far) == Code::ok);
  assembly.set_guard(0.5);
  CHECK(trial(assembly, near) == Code::ok);
  CHECK(trial(assembly, far) == Code::refused);
  REQUIRE(assembly.accept(near).ok());
  CHECK(trial(assembly, far) == Code::ok);  // 0.2 mm from the accepted point
  CHECK(trial(assembly, session->scene->start_coordinates()) == Code::ok);
  CHECK(trial(assembly, with_node(*session, "wire", 4, 0.0, -0.2)) == Code::refused);
}

TEST_CASE("the guard lets nodes slide along the vessel, and wire and vessel move together") {
  const auto session = session_of(straight());
  session->assembly->set_guard(0.5);
  CHECK(trial(*session->assembly, with_node(*session, "wire", 4, 2.2, 0.0)) == Code::ok);
  std::vector<double> q = session->scene->start_coordinates();
  for (const char* name : {"wire", "vessel"}) {
    const Curve& curve = *session->scene->find(name);
    for (int i = 1; i + 1 < curve.view.nodes; ++i) q[at(curve.coordinate_begin + 2 * i + 1)] += 2.5;
  }
  CHECK(trial(*session->assembly, q) == Code::ok);
}

TEST_CASE("the guard refuses an edge that halves in one step, and a station that turns by more than 45 degrees") {
  SmallScene scene = straight();
  const auto session = session_of(scene);
  session->assembly->set_guard(0.5);
  std::vector<double> q = session->scene->start_coordinates();
  REQUIRE(session->scene->find("vessel")->site(Site::edge) != nullptr);
  q = with_node(*session, "vessel", 4, 2.4, 0.0);
  CHECK(trial(*session->assembly, q) == Code::ok);
  CHECK(trial(*session->assembly, with_node(*session, "vessel", 4, 2.6, 0.0)) == Code::refused);

  scene.vessel_kinematics = "edge-frames";
  const auto frames = session_of(scene);
  frames->assembly->set_guard(0.5);
  const Curve& vessel = *frames->scene->find("vessel");
  const int orientation = vessel.coordinate_begin + 2 * vessel.view.nodes;
  std::vector<double> turned = frames->scene->start_coordinates();
  turned[at(orientation + 3)] += 0.75;
  CHECK(trial(*frames->assembly, turned) == Code::ok);
  turned[at(orientation + 3)] += 0.06;
  CHECK(trial(*frames->assembly, turned) == Code::refused);
}

TEST_CASE("a row that leaves its window says so, and an epoch binds rows anew where the accepted point is") {
  SmallScene scene = straight();
  scene.geometry = R"({ type = "line", length = "40 mm", nodes = 21 })";
  std::string text = scene.text();
  text.replace(text.find("window = 20"), 11, "window = 2");
  const auto session = session_of_text(text);
  Assembly& assembly = *session->assembly;
  const int entries = assembly.hessian_pattern().entries();
  const SparsityPattern jacobian = assembly.jacobian_pattern();
  const std::vector<int> before(jacobian.inner.begin(), jacobian.inner.end());

  CHECK(trial(assembly, with_node(*session, "wire", 4, 6.5, 0.0)) == Code::left_window);
  CHECK_FALSE(assembly.epoch_due());
  CHECK(assembly.epochs() == 1);

  const std::vector<double> accepted = with_node(*session, "wire", 4, 5.4, 0.0);
  CHECK(trial(assembly, accepted) == Code::ok);
  REQUIRE(assembly.accept(accepted).ok());
  REQUIRE(assembly.epoch_due());
  REQUIRE(assembly.new_epoch().ok());
  CHECK(assembly.epochs() == 2);
  CHECK_FALSE(assembly.epoch_due());
  CHECK(trial(assembly, with_node(*session, "wire", 4, 6.5, 0.0)) == Code::ok);
  const SparsityPattern rebound = assembly.jacobian_pattern();
  CHECK(std::vector<int>(rebound.inner.begin(), rebound.inner.end()) != before);
  CHECK(assembly.hessian_pattern().entries() > 0);
  CHECK(entries > 0);
}

}  // namespace bowstring::testing
