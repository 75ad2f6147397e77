#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/composition/workbench.hpp"

namespace bowstring::test {

namespace {

using Texts = std::vector<std::string>;

/// The one error of a scene whose wire has this first end, without its position.
std::string error_of(Workbench& bench, const std::string& end) {
  const Texts all = bench.errors(small_scene, {{"wire.w.ends", "[" + end + ", \"pinned\"]"}});
  REQUIRE(all.size() == 1);
  return all[0].substr(all[0].find("]: ") + 3);
}

EndTable end_of(Workbench& bench, const std::string& end) {
  return bench.loaded(small_scene, {{"wire.w.ends", "[" + end + ", \"pinned\"]"}}).wires[0].end[0];
}

}  // namespace

TEST_CASE("what an end holds, axis by axis") {
  Workbench bench;
  const EndTable roller = end_of(bench, R"({ position = ["held", "free"], axes = "end" })");
  CHECK(roller.type == "");
  CHECK(roller.position_held[0]);
  CHECK_FALSE(roller.position_held[1]);
  CHECK_FALSE(roller.rotation_held);
  CHECK(roller.in_end_axes);
  CHECK(roller.text(2) == "(position held free, rotation free)");

  const EndTable turned = end_of(bench, R"({ rotation = "held", turn = "720 deg" })");
  CHECK(turned.position_free());
  CHECK(turned.rotation_held);
  REQUIRE(turned.turn.size() == 1);
  CHECK(turned.turn[0] == doctest::Approx(4.0 * M_PI).epsilon(1e-15));

  const EndTable clamped = end_of(bench, R"({ type = "clamped", turn = 0.1, move = ["1 mm", 0] })");
  CHECK(clamped.text(2) == "clamped");
  CHECK(clamped.move == std::vector<double>{1.0, 0.0});
}

TEST_CASE("contradictory ends are refused in words") {
  Workbench bench;
  CHECK(error_of(bench, R"({ type = "pinned", position = "free" })") ==
        "'position' of the first end of wire 'w' beside its 'type'; expected a type, or what is held axis by axis; "
        "remove one of the two");
  CHECK(error_of(bench, R"({ axes = "end" })") ==
        "the first end of wire 'w' has no 'type'; expected 'free', 'pinned', 'clamped' or 'held-edge'; add type = "
        "\"<end>\", or position and rotation, each \"held\" or \"free\"");
  CHECK(error_of(bench, R"({ position = ["held", "free"], move = [0, 1] })") ==
        "'move' of the first end of wire 'w' moves an axis that is free; expected an end whose position is held; hold "
        "it, as in type = \"pinned\"");
  CHECK(error_of(bench, R"({ type = "pinned", turn = "90 deg" })") ==
        "'turn' of the first end of wire 'w', whose rotation is free; expected an end whose rotation is held; hold it, "
        "as in type = \"clamped\"");
  CHECK(error_of(bench, R"({ type = "held-edge", turn = "90 deg" })") ==
        "'turn' of the first end of wire 'w', whose rotation is free; expected an end whose rotation is held; hold it, "
        "as in type = \"clamped\"");
}

TEST_CASE("what is written wrongly in an end is said to") {
  Workbench bench;
  CHECK(
      error_of(bench, R"({ position = ["held", "loose"] })") ==
      "an entry of 'position' of the first end of wire 'w' is text \"loose\"; expected 'held' or 'free'; write one of "
      "them in quotes");
  CHECK(error_of(bench, R"({ position = ["held", "held", "free"] })") ==
        "'position' of the first end of wire 'w' has 3 entries; expected as many as the scene has dimensions; write "
        "\"held\" or \"free\" for each axis");
  CHECK(
      error_of(bench, R"({ rotation = ["held", "free"] })") ==
      "'rotation' of the first end of wire 'w' has 2 entries; expected one: the plane has one axis of rotation; write "
      "\"held\" or \"free\" for each axis");
  CHECK(
      error_of(bench, R"({ rotation = "held", turn = [1, 2, 3] })") ==
      "'turn' of the first end of wire 'w' has 3 entries; expected one angle, not in a list; write turn = \"90 deg\"");
  CHECK(
      error_of(bench, R"({ type = "clamped", turn = "3 mm" })") ==
      "wrong unit: 'turn' of the first end of wire 'w' is text \"3 mm\"; expected a quantity in rad; write \"3 rad\"");
  CHECK(
      error_of(bench, R"({ type = "clamped", axes = "local" })") ==
      "'axes' of the first end of wire 'w' is text \"local\"; expected 'global' or 'end'; write one of them in quotes");
}

TEST_CASE("spans and spacings") {
  Workbench bench;
  const auto errors = [&](const std::string& key, const std::string& value) {
    const Texts all = bench.errors(small_scene, {{"wire.w." + key, value}});
    REQUIRE(all.size() == 1);
    return all[0].substr(all[0].find(": '") + 2);
  };
  CHECK(bench.loaded(small_scene, {{"wire.w.span", "[\"1 mm\", 3]"}}).wires[0].span == std::vector<double>{1.0, 3.0});
  CHECK(errors("span", "[3, 1]") ==
        "'span' of wire 'w' goes from 3 mm to 1 mm; expected an end beyond its beginning; swap the two, or move them "
        "apart");
  CHECK(errors("span", "[0, 1, 2]") ==
        "'span' of wire 'w' has 3 entries; expected two arc lengths along the vessel, first and last; write span = "
        "[\"0 mm\", \"320 mm\"]");
  CHECK(errors("span", "\"3 mm\"") ==
        "'span' of wire 'w' is text \"3 mm\"; expected two arc lengths along the vessel, first and last; write span = "
        "[\"0 mm\", \"320 mm\"]");
  CHECK(bench.loaded(small_scene, {{"wire.w.spacing", "[0.5, 0.25, 0.25]"}}).wires[0].spacing.size() == 3);
  CHECK(errors("spacing", "[0.5, 0.3]") ==
        "'spacing' of wire 'w' sums to 0.8; expected shares that sum to 1; divide each by 0.8");
  CHECK(
      errors("spacing", "[]") ==
      "'spacing' of wire 'w' is empty; expected a list of each edge's share of the length; write one number per edge, "
      "summing to 1");
  std::string text = small_scene;
  text.replace(text.find("vessel = \"v\"\n"), 13, "geometry = { type = \"csv\", file = \"a.csv\" }\nspan = [0, 1]\n");
  const Texts own = bench.errors(text);
  REQUIRE(own.size() == 1);
  CHECK(own[0].find(
            "'span' of wire 'w' beside a geometry of its own; expected it on a wire that starts along a vessel") !=
        std::string::npos);
}

}  // namespace bowstring::test
