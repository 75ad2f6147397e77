#include <doctest/doctest.h>

#include "tests/allocations.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// What a solver holds.
struct Buffers {
  explicit Buffers(const Problem& problem)
      : q(at(problem.coordinates())),
        x(at(problem.unknowns())),
        gradient(x),
        rows(at(problem.rows())),
        jacobian(at(problem.jacobian_pattern().entries())),
        hessian(at(problem.hessian_pattern().entries())),
        multipliers(random_numbers(problem.rows(), 3)) {
    evaluation.energy = &energy;
    evaluation.gradient = gradient;
    evaluation.rows = rows;
    evaluation.jacobian = jacobian;
  }
  std::vector<double> q, x, gradient, rows, jacobian, hessian, multipliers;
  double energy = 0.0;
  ProblemEvaluation evaluation;
};

std::vector<SmallScene> scenes() {
  std::vector<SmallScene> out;
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const char* centerline : {R"(centerline = "spline")", R"(centerline = "polyline")"}) {
        SmallScene scene;
        scene.dimension = dimension;
        scene.vessel_kinematics = scene.wire_kinematics = kinematics;
        scene.contact = centerline;
        scene.wire_ends = R"(["clamped", "pinned"])";
        scene.vessel_frames = dimension == 3;
        out.push_back(scene);
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the counter sees what plugins and kernel allocate") {
  const auto session = session_of(SmallScene{});
  std::vector<RowReport> report;
  const std::vector<double> q = session->scene->start_coordinates();
  CHECK(allocations_of(
            [&] { REQUIRE(session->scene->constraints[0].constraint->report(*session->assembly, report).ok()); }) > 0);
  CHECK(allocations_of([&] { session->assembly->chart(q); }) > 0);
}

TEST_CASE("evaluate, lagrangian_hessian, retract, values and accept allocate nothing") {
  for (const SmallScene& scene : scenes()) {
    CAPTURE(scene.text());
    const auto session = session_of(scene);
    Assembly& assembly = *session->assembly;
    assembly.set_guard(1e6);
    Buffers out(assembly);
    const std::vector<double> q[] = {moved_start(*session, 0.1, 1), moved_start(*session, 0.2, 2)};
    bool good = true;
    const auto round = [&](const std::vector<double>& state) {
      good = good && assembly.evaluate(state, out.evaluation).ok();
      good = good && assembly.lagrangian_hessian(state, 1.0, out.multipliers, out.hessian).ok();
      assembly.retract(state, out.gradient, out.q);
      assembly.values(state, out.x);
      good = good && assembly.accept(state).ok();
      good = good && !assembly.epoch_due();
    };
    round(q[0]);
    REQUIRE(good);
    CHECK(allocations_of([&] { round(q[1]); }) == 0);
    CHECK(good);
    CHECK(largest(out.hessian) > 0.0);
    CHECK(largest(out.jacobian) > 0.0);
  }
}

TEST_CASE("an epoch whose rows read as many places as some earlier one's allocates nothing") {
  for (const SmallScene& scene : scenes()) {
    CAPTURE(scene.text());
    const auto session = narrow_session(scene);
    Assembly& assembly = *session->assembly;
    const std::vector<double> q[] = {session->scene->start_coordinates(), slid(*session, 1.4)};
    bool good = true;
    const auto round = [&](const std::vector<double>& state) {
      good = good && assembly.accept(state).ok() && assembly.new_epoch().ok();
    };
    std::vector<int> order[2];
    for (std::size_t k = 0; k < 4; ++k) {
      round(q[k % 2]);
      order[k % 2].assign(assembly.order().begin(), assembly.order().end());
    }
    REQUIRE(good);
    REQUIRE(order[0] != order[1]);
    CHECK(allocations_of([&] { round(q[0]), round(q[1]); }) == 0);
    CHECK(good);
  }
}

TEST_CASE("a refused trial point allocates nothing") {
  const auto session = session_of(SmallScene{});
  Assembly& assembly = *session->assembly;
  Buffers out(assembly);
  assembly.set_guard(1e-6);
  Code code = Code::ok;
  const auto refuse = [&](const std::vector<double>& q) { code = assembly.evaluate(q, out.evaluation).code; };
  const std::vector<double> q[] = {moved_start(*session, 0.1, 1), moved_start(*session, 0.2, 2)};
  refuse(q[0]);
  REQUIRE(code == Code::refused);
  CHECK(allocations_of([&] { refuse(q[1]); }) == 0);
  CHECK(code == Code::refused);
}

TEST_CASE("a trial point whose row leaves its window allocates nothing") {
  SmallScene scene;
  scene.contact = "window = 1";
  scene.wire_nodes = 8;
  std::string text = scene.text();
  text.erase(text.find("window = 20\n"), 12);
  const auto session = session_of_text(text);
  Assembly& assembly = *session->assembly;
  Buffers out(assembly);
  Code code = Code::ok;
  const auto leave = [&](const std::vector<double>& q) { code = assembly.evaluate(q, out.evaluation).code; };
  std::vector<double> q[2] = {session->scene->start_coordinates(), {}};
  const int wire = session->scene->find("wire")->coordinate_begin;
  q[0][at(wire + 2 * 3)] += 15.0;  // the fourth node, two segments on
  q[1] = q[0];
  q[1][at(wire + 2 * 3)] += 0.5;
  leave(q[0]);
  REQUIRE(code == Code::left_window);
  CHECK(allocations_of([&] { leave(q[1]); }) == 0);
  CHECK(code == Code::left_window);
}

TEST_CASE("a chart's evaluate, lagrangian_hessian, state and start allocate nothing") {
  for (const SmallScene& scene : scenes()) {
    CAPTURE(scene.text());
    const auto session = session_of(scene);
    Assembly& assembly = *session->assembly;
    Buffers out(assembly);
    const auto chart = assembly.chart(moved_start(*session, 0.1, 1));
    std::vector<double> x[2] = {out.x, out.x};
    for (unsigned k = 0; k < 2; ++k) {
      chart->start(x[k]);
      const std::vector<double> step = random_numbers(assembly.unknowns(), 20 + k);
      for (std::size_t u = 0; u < step.size(); ++u) x[k][u] += 0.05 * step[u];
    }
    bool good = true;
    const auto round = [&](const std::vector<double>& point) {
      good = good && chart->evaluate(point, out.evaluation).ok();
      good = good && chart->lagrangian_hessian(point, 1.0, out.multipliers, out.hessian).ok();
      chart->state(point, out.q);
      chart->start(out.x);
      good = good && !chart->recentre_due(point);
    };
    round(x[0]);
    REQUIRE(good);
    CHECK(allocations_of([&] { round(x[1]); }) == 0);
    CHECK(good);
  }
}

}  // namespace bowstring::testing
