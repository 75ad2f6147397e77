#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <vector>

#include "tests/writers/small_result.hpp"
#include "writers/reading/result.hpp"
#include "writers/svg/figure.hpp"
#include "writers/svg/tube.hpp"

namespace bowstring::testing {

namespace {

std::string figure(const std::string& document) {
  const Written result = written("svg", document);
  REQUIRE_MESSAGE(result.good, result.text);
  return result.text;
}

/// The numbers of an attribute in every element whose text holds `mark`.
std::vector<double> attributes(const std::string& svg, const std::string& mark, const std::string& name) {
  std::vector<double> out;
  const std::regex element("<[^>]*" + mark + "[^>]*>"), value(" " + name + "=\"([^\"]*)\"");
  for (std::sregex_iterator e(svg.begin(), svg.end(), element), end; e != end; ++e) {
    const std::string text = e->str();
    std::smatch found;
    REQUIRE(std::regex_search(text, found, value));
    out.push_back(std::stod(found[1].str()));
  }
  return out;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// Every tag is closed in its order, and no attribute is left open.
void check_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z]+)((?: [a-zA-Z0-9:-]+=\"[^\"<]*\")*)(/?)>");
  std::string rest = svg.substr(svg.find("?>") + 2);
  std::size_t tags = 0;
  for (std::sregex_iterator t(rest.begin(), rest.end(), tag), end; t != end; ++t, ++tags) {
    const std::smatch& match = *t;
    if (match[1].length() > 0) {
      REQUIRE_FALSE(open.empty());
      CHECK(open.back() == match[2].str());
      open.pop_back();
    } else if (match[4].length() == 0) {
      open.push_back(match[2].str());
    }
  }
  CHECK(open.empty());
  CHECK(tags == count(rest, "<"));
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
}

}  // namespace

TEST_CASE("svg: a figure in the plane is one view of both states, with circles whose area is the force") {
  const std::string svg = figure(small_result(2));
  check_well_formed(svg);
  CHECK(svg.find("Small &amp; straight") != std::string::npos);
  CHECK(svg.find("converged · peak displacement 2 mm · 2 contacts · contact force 5 N in all") != std::string::npos);
  CHECK(svg.find("wire wire, stiff") != std::string::npos);
  CHECK(count(svg, "id=\"view-") == 1);
  CHECK(count(svg, "class=\"centerline-1\"") == 1);
  CHECK(count(svg, "class=\"centerline-2\"") == 1);
  CHECK(count(svg, "class=\"wire\"") == 1);
  const std::vector<double> radius = attributes(svg, "class=\"contact\"", "r");
  REQUIRE(radius.size() == 2);
  CHECK(radius[0] == doctest::Approx(2.0 * radius[1]).epsilon(0.01));
}

TEST_CASE("svg: the scale bar is as long as it says") {
  const std::string svg = figure(small_result(2));
  const std::vector<double> from = attributes(svg, "class=\"scale-bar\"", "x1"), to = attributes(svg, "class=\"scale-bar\"", "x2");
  REQUIRE(from.size() == 1);
  const std::vector<double> contact = attributes(svg, "class=\"contact\"", "cx");
  REQUIRE(contact.size() == 2);
  const double scale = std::abs(contact[0] - contact[1]) / 40.0;  // the contacts are 40 mm apart
  CHECK(svg.find(">20 mm</text>") != std::string::npos);
  CHECK(to[0] - from[0] == doctest::Approx(20.0 * scale).epsilon(0.002));
}

TEST_CASE("svg: a scene in space is drawn in two orthogonal views at one scale") {
  const std::string svg = figure(small_result(3));
  check_well_formed(svg);
  CHECK(count(svg, "id=\"view-") == 2);
  CHECK(count(svg, "class=\"wire\"") == 2);
  CHECK(attributes(svg, "class=\"contact\"", "r").size() == 4);
  const std::vector<double> x = attributes(svg, "class=\"contact\"", "cx");
  CHECK(std::abs(x[0] - x[1]) == doctest::Approx(std::abs(x[2] - x[3])).epsilon(0.01));
}

TEST_CASE("svg: what is not known is left out, and a verdict that is bad stands in the figure") {
  std::string document = edited_result(small_result(2), "\"peak_displacement_mm\": 2.0", "\"peak_displacement_mm\": null");
  document = edited_result(document, "[6, 5, 6]", "[6, null, 6]");
  document = edited_result(document, "[50, 2]", "[50, null]");
  document = edited_result(document, "\"status\": \"converged\", \"reason\": \"all thresholds of the certificate hold\"",
                           "\"status\": \"failed\", \"reason\": \"energy <x> gave no number\"");
  const std::string svg = figure(document);
  check_well_formed(svg);
  CHECK(svg.find("failed: energy &lt;x&gt; gave no number") != std::string::npos);
  CHECK(svg.find("peak displacement") == std::string::npos);
}

TEST_CASE("svg: a document without any finite point is refused") {
  std::string document = R"({"format": "bowstring.result/1", "curves": [{"name": "w", "kind": "wire",
    "points": [[null, null]], "reference_points": [[null, null]]}]})";
  const Written result = written("svg", document);
  CHECK_FALSE(result.good);
  CHECK(result.text == "curves: found no point with finite coordinates, expected at least one; look at the document's "
                       "status and reason");
}

TEST_CASE("svg: the outline of a straight tube is two parallels at its radius") {
  const Tube tube = refine({{{{0.0, 0.0}}, {{50.0, 0.0}}, {{100.0, 0.0}}}, {5.0, 5.0, 5.0}});
  const std::vector<Polyline> outline = tube_outline(tube);
  REQUIRE(outline.size() == 2);
  for (const Polyline& run : outline) {
    REQUIRE(run.size() >= 2);
    for (const Vector2& point : run) CHECK(std::abs(point[1]) == doctest::Approx(5.0));
  }
}

TEST_CASE("svg: scale bars are 1, 2 or 5 times a power of ten") {
  CHECK(round_down(7.3) == 5.0);
  CHECK(round_down(4.9) == 2.0);
  CHECK(round_down(0.19) == doctest::Approx(0.1));
  CHECK(round_down(200.0) == doctest::Approx(200.0));
}

}  // namespace bowstring::testing
