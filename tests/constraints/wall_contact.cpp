#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/result/quantities.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, part); });
}

SmallScene with_contact(const std::string& type, const std::string& keys = "") {
  SmallScene scene;
  scene.contact_type = type;
  scene.contact = keys.empty() ? "centerline = \"spline\"" : keys;
  return scene;
}

int rows_of(const SmallScene& scene) { return session_of(scene)->scene->constraints[0].rows.rows; }

/// A rod above a rigid strip of half width 5 mm, pressed down in its middle.
std::string pressed_on_a_strip(const std::string& type) {
  return R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "strip"
geometry = { type = "line", length = "100 mm", nodes = 51 }
radius = "5 mm"
rigid = true
[[wire]]
name = "rod"
geometry = { type = "line", length = "80 mm", nodes = 41, origin = ["10 mm", "6 mm"] }
radius = "0.1 mm"
ends = ["pinned", { position = ["free", "held"] }]
[[energy]]
type = "wire-bending"
on = "rod"
bending-stiffness = "1000 N mm^2"
[[energy]]
type = "point-load"
on = "rod"
force = ["0 N", "-0.5 N"]
at = "40 mm"
[[constraint]]
type = ")" +
         type + R"("
on = ["rod", "strip"]
side = "outside"
[solver]
type = "ipopt"
)";
}

}  // namespace

TEST_CASE("how many rows each discretisation has") {
  CHECK(rows_of(with_contact("node-wise-contact")) == 5);  // seven nodes, two of them held
  CHECK(rows_of(with_contact("segment-wise-contact")) == 5 + 6);
  CHECK(rows_of(with_contact("segment-wise-contact", "rows-per-segment = \"auto\"")) == 5 + 6);
  CHECK(rows_of(with_contact("segment-wise-contact", "rows-per-segment = 3")) == 5 + 6 * (3 + 2));
  CHECK(rows_of(with_contact("node-wise-contact", "rows-per-segment = 3")) == 5 + 6 * 2);
  SmallScene free = with_contact("segment-wise-contact");
  free.wire_ends = R"(["free", "free"])";
  CHECK(rows_of(free) == 7 + 6);
  free.contact_type = "node-wise-contact";
  CHECK(rows_of(free) == 7);
  SmallScene equal = with_contact("same-index-contact");
  equal.wire_nodes = 8;
  CHECK(rows_of(equal) == 6);
}

TEST_CASE("rows-per-segment = \"auto\" keeps rows closer than 0.65 of the smallest clearance") {
  const SmallScene scene = with_contact("node-wise-contact", "rows-per-segment = \"auto\"");
  const auto session = session_of(scene);
  const Curve& wire = *session->scene->find("wire");
  const double edge = *std::max_element(wire.edge_length.begin(), wire.edge_length.end());
  const int per_segment = 1 + (session->scene->constraints[0].rows.rows - 5) / 6;
  const double clearance = 3.0 - 0.4;
  CHECK(edge / per_segment <= 0.65 * clearance);
  CHECK(edge / (per_segment - 1) > 0.65 * clearance);
  CHECK_FALSE(any_contains(session->scene->warnings, "farther than the smallest clearance"));
  CHECK(any_contains(session_of(with_contact("node-wise-contact"))->scene->warnings,
                     "mm apart, farther than the smallest clearance (2.6 mm), so the wall may pass between them; use "
                     "rows-per-segment = \"auto\", segment-wise-contact, or more wire nodes"));
}

TEST_CASE("what a contact cannot be is refused in words") {
  CHECK(
      contains(refusal_of(with_contact("same-index-contact").text()),
               "same-index-contact compares nodes of the same number, but wire 'wire' has 7 nodes and vessel 'vessel' "
               "8; give both the same number, or use type = \"node-wise-contact\""));
  CHECK(contains(refusal_of(with_contact("node-wise-contact", "rows-per-segment = 1.5").text()),
                 "'rows-per-segment' is 1.5; expected a whole number, or \"auto\""));
  CHECK(contains(refusal_of(with_contact("node-wise-contact", "side = \"under\"").text()),
                 "'side' of constraint 'lumen' is text \"under\"; expected 'inside' or 'outside'"));
}

TEST_CASE("keys that a discretisation does not feel are allowed, and said to be idle") {
  const auto idle = [](const SmallScene& scene) { return session_of(scene)->scene->without_effect; };
  CHECK(any_contains(idle(with_contact("segment-wise-contact", "rows-per-segment = \"auto\"")),
                     "'rows-per-segment' of constraint 'lumen' has no effect: segment-wise-contact finds the place of "
                     "the largest gap"));
  SmallScene equal = with_contact("same-index-contact");
  equal.wire_nodes = 8;
  CHECK(any_contains(idle(equal),
                     "'window' of constraint 'lumen' has no effect: same-index-contact searches no closest "
                     "point"));
  CHECK(idle(with_contact("node-wise-contact", "rows-per-segment = 2")).empty());
}

TEST_CASE("a wire that starts outside of its tube is allowed, and said where and by how much") {
  std::string text = pressed_on_a_strip("node-wise-contact");
  text.replace(text.find("\"6 mm\""), 6, "\"4 mm\"");
  const auto session = session_of_text(text);
  CHECK(any_contains(session->scene->warnings, "wire 'rod' starts inside of 'strip' by up to 1.1 mm, at s = "));
  text.replace(text.find("side = \"outside\""), 16, "side = \"inside\"");
  text.replace(text.find("\"4 mm\""), 6, "\"7 mm\"");
  CHECK(any_contains(session_of_text(text)->scene->warnings,
                     "wire 'rod' starts outside of 'strip' by up to 2.1 mm, at s = "));
}

TEST_CASE("a smooth distance says how far it lets the wire into the wall") {
  const SmallScene scene = with_contact("node-wise-contact", "gap = \"smooth-distance\"");
  CHECK(any_contains(session_of(scene)->scene->warnings,
                     "the smooth distance lets the wire into the wall by up to 0.001 mm"));
}

TEST_CASE("segment rows cover the wall from one end of a long segment to the other") {
  SmallScene scene = with_contact("segment-wise-contact", "window = 1");
  scene.geometry = R"({ type = "arc", radius = "60 mm", angle = "80 deg", nodes = 81 })";
  scene.radius = "\"4 mm\"";
  scene.wire_nodes = 9;
  scene.wire_ends = R"(["clamped", "free"])";
  std::string text = edited(scene.text(), "window = 20\n", "");
  const auto session = session_of_text(text);
  CHECK(solve(*session, nullptr).certificate.verdict == Verdict::converged);
}

TEST_CASE("a window beyond any vessel is the whole of it, and too many rows are refused") {
  const auto places = [](const std::string& window) {
    const auto session = session_of_text(edited(SmallScene{}.text(), "window = 20", "window = " + window));
    return session->scene->constraints[0].rows.places.size();
  };
  CHECK(places("2147483647") == places("8"));
  CHECK(places("\"1e12 mm\"") == places("8"));
  CHECK(contains(refusal_of(with_contact("node-wise-contact", "rows-per-segment = 1e12").text()), "at most 1000"));
}

TEST_CASE("the clearance that rows are spaced by is that of the wire where it lies") {
  SmallScene scene = with_contact("node-wise-contact", "rows-per-segment = \"auto\"");
  scene.radius = R"({ table = [["0 mm", "5 mm"], ["60 mm", "1.5 mm"]] })";
  scene.wire_ends = R"(["clamped", "free"])";  // a wire whose length slides has one radius
  const std::string text =
      edited(scene.text(), "radius = \"0.4 mm\"", R"(radius = { table = [["0 mm", "2 mm"], ["60 mm", "0.3 mm"]] })");
  const auto session = session_of_text(text);
  CHECK(session->scene->constraints[0].rows.rows > 6);
  CHECK_FALSE(any_contains(session->scene->warnings, "farther than the smallest clearance"));
}

TEST_CASE("outside: a rod lies on a strip, which pushes it away") {
  for (const char* type : {"node-wise-contact", "segment-wise-contact"}) {
    const std::string name = type;
    CAPTURE(name);
    const auto session = session_of_text(pressed_on_a_strip(type));
    const Solution solution = solve(*session, nullptr);
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    CHECK(solution.certificate.pairs.empty());  // no lumen that it could leave
    Readings readings;
    REQUIRE(read_solution(*session, solution, readings).ok());
    double pushed = 0.0, lowest = 1e300;
    for (const ContactRecord& contact : readings.contacts) pushed += contact.force * contact.direction[1];
    const std::vector<double>& p = readings.curves[at(session->scene->find("rod")->view.index)].points;
    for (std::size_t i = 1; i < p.size(); i += 2) lowest = std::min(lowest, p[i]);
    CHECK(lowest == doctest::Approx(5.1).epsilon(1e-6));
    CHECK(pushed > 0.1);
    double supported = 0.0;
    for (const SupportRecord& support : readings.supports) {
      if (session->scene->curves[at(support.curve)]->name == "rod") supported += support.force[1];
    }
    CHECK(supported + pushed == doctest::Approx(0.5).epsilon(1e-6));
  }
}

TEST_CASE("a segment whose wall bends away leaves contact to its nodes, and the rows stay as many") {
  // A stiff straight rod in a tube that bends away from it: its ends touch the wall.
  const auto session = session_of_file(
      "rod-in-arc-tube.toml", {{"constraint.lumen.type", "segment-wise-contact"}, {"vessel.tube.radius", "0.85"}});
  const int rows = session->scene->constraints[0].rows.rows;
  CHECK(rows == 201 + 200);
  const Solution solution = solve(*session, nullptr);
  REQUIRE(solution.certificate.verdict == Verdict::converged);
  CHECK(session->scene->constraints[0].rows.rows == rows);
  Readings readings;
  REQUIRE(read_solution(*session, solution, readings).ok());
  CHECK(readings.quantities.contact_force == doctest::Approx(0.57735).epsilon(0.01));
  CHECK(*solution.certificate.dense_penetration() <= 1e-6);
}

TEST_CASE("rows bound at a solved state lie where the solve has led them, whatever many segments away") {
  for (const char* type : {"node-wise-contact", "same-index-contact", "concentric"}) {
    const std::string name = type;
    CAPTURE(name);
    const auto session = session_of_file("tortuous-iliac.toml", {{"constraint.lumen.type", name}});
    const Solution solution = solve(*session, {});
    REQUIRE(solution.certificate.verdict == Verdict::converged);
    const int constraint = static_cast<int>(session->scene->constraints.size()) - 1;
    std::vector<RowReport> led, bound;
    REQUIRE(session->assembly->report(solution.q, constraint, led).ok());
    const int epochs = session->assembly->epochs();

    session->scene->constraints.back().constraint->declare(session->scene->constraints.back().scene,
                                                           session->scene->constraints.back().rows);
    Assembly assembly(*session->scene, solution.q);
    CHECK(assembly.epochs() == 1);
    CHECK_FALSE(assembly.epoch_due());
    REQUIRE(assembly.report(solution.q, constraint, bound).ok());
    REQUIRE(bound.size() == led.size());
    double slid = 0.0;
    for (std::size_t r = 0; r < led.size(); ++r) {
      CAPTURE(r);
      CHECK(std::fabs(bound[r].vessel_coordinate - led[r].vessel_coordinate) < 1e-6);
      slid = std::max(slid, std::fabs(led[r].vessel_coordinate - led[r].wire_coordinate));
    }
    if (name == "same-index-contact") continue;
    CHECK(slid > 1.0);
    CHECK(epochs > 1);
    std::vector<double> rows(at(assembly.rows()));
    ProblemEvaluation evaluation;
    evaluation.rows = rows;
    REQUIRE(assembly.evaluate(solution.q, evaluation).ok());
    for (int r = 0; r < assembly.rows(); ++r) {
      CHECK(rows[at(r)] <= assembly.row_upper()[at(r)] + 1e-8);
      CHECK(rows[at(r)] >= assembly.row_lower()[at(r)] - 1e-8);
    }
  }
}

}  // namespace bowstring::testing
