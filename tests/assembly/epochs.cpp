#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct Patterns {
  explicit Patterns(const Assembly& assembly)
      : jacobian_begin(copy(assembly.jacobian_pattern().begin)),
        jacobian(copy(assembly.jacobian_pattern().inner)),
        hessian_begin(copy(assembly.hessian_pattern().begin)),
        hessian(copy(assembly.hessian_pattern().inner)),
        order(copy(assembly.order())),
        local_unknowns(copy(assembly.local_unknowns())),
        border(assembly.border()) {
    for (const LocalRows& rows : assembly.local_rows()) {
      local_rows.insert(local_rows.end(), {rows.first_row, rows.rows, rows.first_local, rows.locals});
    }
  }
  static std::vector<int> copy(Span<const int> numbers) { return {numbers.begin(), numbers.end()}; }

  bool operator==(const Patterns&) const = default;

  std::vector<int> jacobian_begin, jacobian, hessian_begin, hessian, order, local_rows, local_unknowns;
  int border;
};

/// Everything that stands in patterns, one number after the other.
std::vector<double> numbers_of(Assembly& assembly, const std::vector<double>& q) {
  std::vector<double> gradient(at(assembly.unknowns())), rows(at(assembly.rows())),
      jacobian(at(assembly.jacobian_pattern().entries())), hessian(at(assembly.hessian_pattern().entries()));
  ProblemEvaluation evaluation;
  evaluation.gradient = gradient;
  evaluation.rows = rows;
  evaluation.jacobian = jacobian;
  REQUIRE(assembly.evaluate(q, evaluation).ok());
  REQUIRE(assembly.lagrangian_hessian(q, 0.7, random_numbers(assembly.rows(), 5), hessian).ok());
  std::vector<double> out = gradient;
  for (const std::vector<double>* more : {&rows, &jacobian, &hessian})
    out.insert(out.end(), more->begin(), more->end());
  return out;
}

/// How far the wire can slide at once: rows of a wire without clearance do not search beyond their windows.
double slide(const SmallScene& scene) { return scene.contact_type == "concentric" ? 0.6 : 1.4; }

/// Rows of other kinds remember how they came to a place: their axes, or where on a chord they stand.
bool forgets(const SmallScene& scene) { return scene.contact_type == "node-wise-contact"; }

std::vector<SmallScene> scenes() {
  std::vector<SmallScene> out;
  for (const int dimension : {2, 3}) {
    for (const char* type : {"node-wise-contact", "segment-wise-contact", "concentric"}) {
      for (const char* kinematics : {"nodes", "edge-frames"}) {
        SmallScene scene;
        scene.dimension = dimension;
        scene.contact_type = type;
        scene.vessel_kinematics = scene.wire_kinematics = kinematics;
        scene.wire_ends = R"(["clamped", "pinned"])";
        out.push_back(scene);
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("patterns after an epoch are those of an assembly that is made at that place") {
  for (const SmallScene& scene : scenes()) {
    CAPTURE(scene.text());
    const auto session = narrow_session(scene);
    Assembly& assembly = *session->assembly;
    const Patterns first(assembly);
    const std::vector<double> q = slid(*session, slide(scene));
    REQUIRE(assembly.accept(q).ok());
    REQUIRE(assembly.new_epoch().ok());
    const Patterns rebound(assembly);
    CHECK_FALSE(rebound == first);
    const std::vector<double> numbers = forgets(scene) ? numbers_of(assembly, q) : std::vector<double>();

    Assembly made(*session->scene, q);
    CHECK(Patterns(made) == rebound);
    if (!forgets(scene)) continue;
    const std::vector<double> expected = numbers_of(made, q);
    REQUIRE(largest(expected) > 0.0);
    CHECK(largest_difference(numbers, expected) <= 1e-9 * largest(expected));
  }
}

TEST_CASE("epochs there and back leave nothing behind: patterns and numbers are what they were") {
  for (const SmallScene& scene : scenes()) {
    // Its axes decide on which side of a vessel node a place at that node falls.
    if (scene.contact_type == "concentric") continue;
    CAPTURE(scene.text());
    const auto session = narrow_session(scene);
    Assembly& assembly = *session->assembly;
    const std::vector<double> start = session->scene->start_coordinates();
    const Patterns first(assembly);
    const std::vector<double> expected = numbers_of(assembly, start);
    REQUIRE(largest(expected) > 0.0);
    for (const double along : {1.0, 0.0, -0.8, 0.0}) {
      REQUIRE(assembly.accept(slid(*session, along * slide(scene))).ok());
      REQUIRE(assembly.new_epoch().ok());
      CHECK((Patterns(assembly) == first) == (along == 0.0));
    }
    if (forgets(scene)) CHECK(largest_difference(numbers_of(assembly, start), expected) <= 1e-9 * largest(expected));
    CHECK(assembly.epochs() == 5);
  }
}

TEST_CASE("an epoch in which no row reads other places leaves the patterns alone") {
  const auto session = narrow_session(SmallScene{});
  Assembly& assembly = *session->assembly;
  const std::vector<double> q = moved_start(*session, 1e-3, 7);
  const Patterns before(assembly);
  REQUIRE(assembly.accept(q).ok());
  const std::vector<double> numbers = numbers_of(assembly, q);
  REQUIRE(largest(numbers) > 0.0);
  REQUIRE(assembly.new_epoch().ok());
  CHECK(Patterns(assembly) == before);
  CHECK(numbers_of(assembly, q) == numbers);
  CHECK(assembly.epochs() == 2);
}

TEST_CASE("a state that is accepted after it has been evaluated is accepted as one that has not") {
  std::vector<SmallScene> all;
  for (SmallScene scene : scenes()) {
    for (const char* centerline : {R"(centerline = "spline")", R"(centerline = "polyline")"}) {
      scene.contact = centerline;
      all.push_back(scene);
    }
  }
  for (const SmallScene& scene : all) {
    CAPTURE(scene.text());
    const auto evaluated = session_of(scene), plain = session_of(scene);
    const std::vector<double> q = moved_start(*plain, 0.2, 4), further = moved_start(*plain, 0.3, 6);
    std::vector<double> rows(at(plain->assembly->rows()));
    for (const bool beyond_window : {false, true}) {
      ProblemEvaluation trial;
      trial.beyond_window = beyond_window;
      trial.rows = rows;
      evaluated->assembly->set_guard(1e6);
      plain->assembly->set_guard(1e6);
      REQUIRE(evaluated->assembly->evaluate(q, trial).ok());
      REQUIRE(largest(rows) > 0.0);
      REQUIRE(evaluated->assembly->accept(q).ok());
      REQUIRE(plain->assembly->accept(q).ok());
      CHECK(numbers_of(*evaluated->assembly, further) == numbers_of(*plain->assembly, further));
      CHECK(evaluated->assembly->travelled() == plain->assembly->travelled());
    }
  }
}

}  // namespace bowstring::testing
