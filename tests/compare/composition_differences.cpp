#include "core/compare/composition_differences.hpp"

#include <doctest/doctest.h>

#include "core/compare/result_differences.hpp"
#include "core/composition/composition.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

const char* const scene = R"(schema = 1
title = "one"
[scene]
dimension = 3
[[vessel]]
name = "v"
geometry = { type = "arcs", nodes = 20, segments = [{ length = "60 mm" }, { length = "40 mm", bend = "70 deg" }] }
radius = "5 mm"
ends = ["pinned", "clamped"]
[[wire]]
name = "w"
vessel = "v"
radius = { table = [["0 mm", "0.3 mm"], ["50 mm", "0.4 mm"]] }
[[energy]]
type = "wire-bending"
on = "w"
bending-stiffness = "65 N mm^2"
[[energy]]
type = "anchoring"
on = "v"
stiffness = "0.03 N/mm"
[[constraint]]
type = "node-wise-contact"
on = ["w", "v"]
)";

std::string resolved(const std::string& text, const std::vector<Override>& overrides = {}) {
  CompositionRequest request;
  request.file = scene_file("compared.toml");
  request.text = text;
  request.overrides = overrides;
  const CompositionOutcome outcome = load_composition(request, plugins());
  REQUIRE_MESSAGE(outcome.composition, (outcome.errors.empty() ? "" : outcome.errors.front().text()));
  return outcome.composition->resolved_json;
}

std::string line(const CompositionDifference& one) {
  return one.path + ": " + one.a.value_or("(none)") + " | " + one.b.value_or("(none)") +
         (one.because_of.empty() ? "" : " because of " + one.because_of);
}

using Lines = std::vector<std::string>;

Lines differences(const std::string& a, const std::string& b, Registry* registry = &plugins()) {
  Lines out;
  for (const CompositionDifference& one : composition_differences(a, b, registry)) out.push_back(line(one));
  return out;
}

/// Against the scene with overrides.
Lines changed(const std::vector<Override>& overrides) {
  return differences(resolved(scene), resolved(scene, overrides));
}

int things(const std::vector<CompositionDifference>& differences) {
  Comparison comparison;
  comparison.composition = differences;
  return comparison.things();
}

}  // namespace

TEST_CASE("nothing differs from itself") { CHECK(changed({}) == Lines{}); }

TEST_CASE("values stand in their units, at the paths that --set takes") {
  CHECK(changed({{"energy.wire-bending.bending-stiffness", "70 N mm^2"}}) ==
        Lines{"energy.wire-bending.bending-stiffness: 65 N mm^2 | 70 N mm^2"});
  CHECK(changed({{"energy.anchoring.stiffness", "0.02 N/mm^2"}}) ==
        Lines{"energy.anchoring.stiffness: 0.03 N/mm | 0.02 N/mm^2"});
  CHECK(changed({{"vessel.v.radius", "6 mm"}, {"vessel.v.geometry.nodes", "30"}}) ==
        Lines{"vessel.v.geometry.nodes: 20 | 30", "vessel.v.radius: 5 mm | 6 mm"});
  CHECK(changed({{"wire.w.span", "['0 mm', '50 mm']"}}) == Lines{"wire.w.span: (none) | [\"0 mm\", \"50 mm\"]"});
  CHECK(changed({{"certificate.multiplier", "-1e-7 N"}}) == Lines{"certificate.multiplier: -1e-08 N | -1e-07 N"});
  CHECK(changed({{"vessel.v.rigid", "true"}}) == Lines{"vessel.v.rigid: false | true"});
}

TEST_CASE("what a difference says can be set, and then nothing differs") {
  const std::string one = resolved(scene), other = resolved(scene, {{"vessel.v.radius", "6 mm"},
                                                                    {"wire.w.span", "['0 mm', '50 mm']"},
                                                                    {"solver.tolerance", "1e-9"},
                                                                    {"energy.anchoring.stiffness", "0.02 N/mm^2"},
                                                                    {"wire.w.ends.first", "clamped"},
                                                                    {"wire.w.ends.first.turn", "10 deg"}});
  std::vector<Override> overrides;
  for (const CompositionDifference& difference : composition_differences(one, other, &plugins())) {
    REQUIRE(difference.b);
    overrides.push_back({difference.path, *difference.b});
  }
  CHECK(overrides.size() == 6);
  CHECK(resolved(scene, overrides) == other);
}

TEST_CASE("ends by first and last, a name or a table alike") {
  CHECK(changed({{"vessel.v.ends.first", "free"}}) == Lines{"vessel.v.ends.first: pinned | free"});
  CHECK(changed({{"vessel.v.ends.last.turn", "0.5 rad"}}) == Lines{"vessel.v.ends.last.turn: (none) | 0.5 rad"});
  CHECK(changed({{"vessel.v.ends.first", "{ position = 'held', rotation = 'held' }"}}) ==
        Lines{"vessel.v.ends.first: pinned | { position = [\"held\", \"held\", \"held\"], rotation = \"held\" }"});
}

TEST_CASE("a profile of another form, a list of tables: one difference") {
  CHECK(changed({{"wire.w.radius", "0.4 mm"}}) ==
        Lines{"wire.w.radius: { table = [[\"0 mm\", \"0.3 mm\"], [\"50 mm\", \"0.4 mm\"]] } | 0.4 mm"});
  const Lines lines = changed({{"vessel.v.geometry.segments", "[{ length = '60 mm' }]"}});
  REQUIRE(lines.size() == 1);
  CHECK(contains(lines.front(), "vessel.v.geometry.segments: [{ length = \"60 mm\""));
}

TEST_CASE("another type is one thing, with what it brings along") {
  const auto found =
      composition_differences(resolved(scene), resolved(scene, {{"solver.type", "trust-region"}}), &plugins());
  REQUIRE_FALSE(found.empty());
  CHECK(line(found.front()) == "solver.type: interior-point | trust-region");
  for (std::size_t i = 1; i < found.size(); ++i) CHECK(found[i].because_of == "solver.type");
  CHECK(things(found) == 1);
}

TEST_CASE("a term without a name stays the same term when its type changes") {
  const Lines lines = changed({{"constraint.node-wise-contact.type", "segment-wise-contact"}});
  REQUIRE_FALSE(lines.empty());
  CHECK(lines.front() == "constraint.node-wise-contact.type: node-wise-contact | segment-wise-contact");
}

TEST_CASE("what is in one alone") {
  const std::string more = std::string(scene) +
                           "[[energy]]\nname = \"pull\"\ntype = \"axial-tension\"\non = \"w\"\n"
                           "tension = \"3 N\"\n[multistart]\nseed = 3\n";
  const Lines lines = differences(resolved(scene), resolved(more));
  REQUIRE(lines.size() == 2);
  CHECK(contains(lines[0], "energy.pull: (none) | { name = \"pull\", on = \"w\", type = \"axial-tension\""));
  CHECK(contains(lines[1], "multistart: (none) | { starts = 8, seed = 3"));
  CHECK(contains(differences(resolved(more), resolved(scene))[0], "energy.pull: { name = \"pull\""));
}

TEST_CASE("a title differs, and is behind nothing") {
  const auto found = composition_differences(
      resolved(scene), resolved(scene, {{"title", "two"}, {"vessel.v.radius", "6 mm"}}), &plugins());
  REQUIRE(found.size() == 2);
  CHECK(line(found.front()) == "title: one | two");
  CHECK(things(found) == 1);
}

TEST_CASE("steps: what differs in a state alone, at the path of that step") {
  const std::string chain = std::string(scene) +
                            "[[step]]\nname = \"in\"\n[[step]]\nname = \"soft wire\"\n"
                            "\"energy.wire-bending.bending-stiffness\" = \"50 N mm^2\"\n";
  const std::string one = resolved(chain);
  CHECK(differences(one, resolved(chain, {{"vessel.v.radius", "6 mm"}})) == Lines{"vessel.v.radius: 5 mm | 6 mm"});
  const std::string path = "step.soft wire.\"energy.wire-bending.bending-stiffness\"";
  const std::string other = resolved(chain, {{path, "40 N mm^2"}});
  CHECK(differences(one, other) == Lines{path + ": 50 N mm^2 | 40 N mm^2"});
  CHECK(differences(one, resolved(chain, {{"step.soft wire.rest", "previous"}})) ==
        Lines{"step.soft wire.rest: (none) | previous"});
  CHECK(differences(one, resolved(scene)) == Lines{"step: in, soft wire | (none)"});
  CHECK(differences(one, resolved(chain + "[[step]]\nname = \"out\"\n")) == Lines{"step.out: (none) | out"});
  const auto titled = composition_differences(one, resolved(chain, {{"step.in.title", "t"}}), &plugins());
  CHECK(things(titled) == 0);
}

TEST_CASE("without a registry numbers stand without the units of plugins") {
  CHECK(differences(resolved(scene), resolved(scene, {{"energy.wire-bending.bending-stiffness", "70 N mm^2"}}),
                    nullptr) == Lines{"energy.wire-bending.bending-stiffness: 65 | 70"});
}

}  // namespace bowstring
