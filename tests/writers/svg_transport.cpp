#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/writers/small_result.hpp"
#include "writers/reading/transport.hpp"
#include "writers/svg/projection.hpp"

namespace bowstring::testing {

namespace {

/// A document as `bowstring transport --json` prints it, by hand: a curve of three places to two places.
std::string small_transport() {
  return R"({"format": "bowstring.transport/1", "method": {"type": "exact"}, "ground_cost": {"type": "euclidean"},
    "value": 12.5, "unit": "mm^2", "plan": {"row": [0, 1, 2, 2], "column": [0, 0, 0, 1], "mass": [0.4, 0.2, 0.1, 0.3]},
    "certificate": {"holds": true}, "unique": false,
    "a": {"name": "a<1>.csv#curve", "kind": "curve", "positions": [[0, 0, 0], [10, 0, 5], [20, 0, 0]],
          "weights": [0.4, 0.2, 0.4]},
    "b": {"name": "b.csv", "kind": "places", "positions": [[0, 10, 0], [20, 10, 0]], "weights": [0.7, 0.3]}})";
}

std::string picture(const std::string& document) {
  const Written result = written("svg", document);
  REQUIRE_MESSAGE(result.good, result.text);
  return result.text;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::string refusal(const std::string& word, const std::string& by) {
  const Written result = written("svg", edited_result(small_transport(), word, by));
  CHECK_FALSE(result.good);
  return result.text;
}

/// What stands in the group of this id.
std::string group(const std::string& svg, const std::string& id) {
  const std::size_t begin = svg.find("<g id=\"" + id + "\"");
  REQUIRE(begin != std::string::npos);
  return svg.substr(begin, svg.find("</g>", begin) - begin);
}

}  // namespace

TEST_CASE("svg of a plan: both measures, a line for each entry, and the figures in words") {
  const std::string svg = picture(small_transport());
  CHECK(count(svg, "<g") - count(svg, "</g>") == 0);
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  CHECK(count(group(svg, "plan"), "<line") == 4);
  CHECK(count(group(svg, "measure-a"), "<circle") == 3);
  CHECK(count(group(svg, "measure-a"), "<polyline") == 1);
  CHECK(count(group(svg, "measure-b"), "<circle") == 2);
  CHECK(count(group(svg, "measure-b"), "<polyline") == 0);
  CHECK(svg.find("Transport by exact, ground cost euclidean") != std::string::npos);
  CHECK(svg.find("value 12.5 mm^2 · 4 of 6 entries are not zero · certified · another plan has the same value") !=
        std::string::npos);
  CHECK(svg.find("A: a&lt;1&gt;.csv#curve, 3 places") != std::string::npos);
  CHECK(svg.find("B: b.csv, 2 places") != std::string::npos);
  // The heaviest entry is drawn last, the widest.
  const std::string plan = group(svg, "plan");
  CHECK(plan.rfind("stroke-width=\"1.80\"") > plan.rfind("stroke-width=\"0.45\""));
}

TEST_CASE("svg of a plan: a failed certificate is seen, and a dense plan says what is left out") {
  std::string svg = picture(edited_result(small_transport(), "\"holds\": true", "\"holds\": false"));
  CHECK(svg.find("the certificate does not hold") != std::string::npos);
  svg = picture(edited_result(small_transport(), "[0.4, 0.2, 0.1, 0.3]", "[0.4, 0.2, 0.3999, 0.0001]"));
  CHECK(count(group(svg, "plan"), "<line") == 3);
  CHECK(svg.find("plan, width by mass: 99.99 % of it") != std::string::npos);
}

TEST_CASE("svg of a plan: documents that are none") {
  const std::string mend = "; give the document as `bowstring` prints it with --json";
  CHECK(refusal("\"row\": [0, 1, 2, 2]", "\"row\": [0, 1, 2, 3]") ==
        "plan.row: found number, expected the index of a place, below 3" + mend);
  CHECK(refusal("[0.7, 0.3]", "[0.7]") == "b.weights: found 1 entries, expected 2, one per place" + mend);
  CHECK(refusal("[[0, 10, 0], [20, 10, 0]]", "[]") == "b.positions: found no place, expected at least one" + mend);
  for (const char* writer : {"csv", "vtp"}) {
    CHECK(written(writer, small_transport()).text.find("this writer takes results, and no comparison of measures") !=
          std::string::npos);
  }
}

TEST_CASE("the widest view of places is x and y where they lie in such a plane, else that of largest spread") {
  const View flat = widest_view({{{0, 0, 3}}, {{1, 50, 3}}});
  CHECK(flat.right == Vector3::unit(0));
  CHECK(flat.up == Vector3::unit(1));
  const View tilted = widest_view({{{0, 0, 0}}, {{1, 0, 50}}, {{1, 10, 100}}, {{0, -10, 100}}});
  CHECK(std::abs(tilted.right[2]) > 0.9);
  CHECK(std::abs(tilted.up[1]) > 0.9);
}

}  // namespace bowstring::testing
