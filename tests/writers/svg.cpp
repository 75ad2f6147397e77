#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <vector>

#include "tests/writers/small_result.hpp"
#include "writers/reading/result.hpp"
#include "writers/svg/figure.hpp"

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
  const std::regex element((mark[0] == '<' ? "" : "<[^>]*") + mark + "[^>]*>"), value(" " + name + "=\"([^\"]*)\"");
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

TEST_CASE("svg: every contact with a force has its circle, and its radius grows with the force") {
  const std::string last = "\"s_mm\": 70, \"force_N\": 4.0}";
  const std::string svg =
      figure(edited_result(small_result(2), last, last + R"(, {"wire": "wire, stiff", "s_mm": 100, "force_N": 2.0},
        {"wire": "wire, stiff", "s_mm": 0, "force_N": 0.01}, {"wire": "wire, stiff", "s_mm": 30, "force_N": 1e-9}, {"wire": "wire, stiff", "s_mm": 70, "force_N": null},
        {"wire": "wire, stiff", "s_mm": null, "force_N": 3.0})"));
  check_well_formed(svg);
  const std::vector<double> radius = attributes(svg, "class=\"contact\"", "r");
  REQUIRE(radius.size() == 4);
  const double forces[] = {4.0, 2.0, 1.0, 0.01};  // the largest is drawn first
  for (std::size_t i = 1; i < radius.size(); ++i) {
    CHECK(radius[i] < radius[i - 1]);
    CHECK(radius[i] / radius[0] == doctest::Approx(std::sqrt(forces[i] / forces[0])).epsilon(0.02));
  }
}

TEST_CASE("svg: where no force acts there is no circle and no entry for one") {
  std::string document = edited_result(small_result(2), "\"force_N\": 1.0", "\"force_N\": 0.0");
  document = edited_result(document, "\"force_N\": 4.0", "\"force_N\": null");
  const std::string svg = figure(document);
  check_well_formed(svg);
  CHECK(count(svg, "<circle") == 0);
  CHECK(svg.find("area by force") == std::string::npos);
}

TEST_CASE("svg: ends that are held in the same place share a symbol") {
  const std::string svg = figure(small_result(2));
  CHECK(count(svg, "class=\"support\"") == 3);  // two in the drawing, one in the legend
}

TEST_CASE("svg: what is drawn and written lies on the page") {
  const std::string title =
      "A title that is so long that no page could hold it in a single line, because it "
      "tells all that there is to tell about the scene";
  for (const int dimension : {2, 3}) {
    const std::string svg = figure(edited_result(small_result(dimension), "Small & straight", title));
    check_well_formed(svg);
    CHECK(count(svg, "tell about the scene</text>") == 1);
    const double width = attributes(svg, "<svg", "width").at(0), height = attributes(svg, "<svg", "height").at(0);
    const std::regex points(" points=\"([^\"]+)\""), pair("([-0-9.]+),([-0-9.]+)");
    std::size_t seen = 0;
    for (std::sregex_iterator p(svg.begin(), svg.end(), points), end; p != end; ++p) {
      const std::string text = (*p)[1].str();
      for (std::sregex_iterator xy(text.begin(), text.end(), pair); xy != end; ++xy, ++seen) {
        const double x = std::stod((*xy)[1].str()), y = std::stod((*xy)[2].str());
        CHECK((x > 0.0 && x < width));
        CHECK((y > 0.0 && y < height));
      }
    }
    CHECK(seen > 20);
  }
}

TEST_CASE("svg: the scale bar is as long as it says") {
  const std::string svg = figure(small_result(2));
  const std::vector<double> from = attributes(svg, "class=\"scale-bar\"", "x1");
  const std::vector<double> to = attributes(svg, "class=\"scale-bar\"", "x2");
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
  std::string document = edited_result(small_result(2), "displacement_mm\": 2.0", "displacement_mm\": null");
  document = edited_result(document, "[6, 5, 6]", "[6, null, 6]");
  document = edited_result(document, "[50, 2]", "[50, null]");
  document = edited_result(document, "\"status\": \"converged\"", "\"status\": \"failed\"");
  document = edited_result(document, "all thresholds of the certificate hold", "energy <x> gave no number");
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
  CHECK(result.text ==
        "curves: found no point with finite coordinates, expected at least one; look at the document's "
        "status and reason");
}

TEST_CASE("svg: scale bars are 1, 2 or 5 times a power of ten") {
  CHECK(round_down(7.3) == 5.0);
  CHECK(round_down(4.9) == 2.0);
  CHECK(round_down(0.19) == doctest::Approx(0.1));
  CHECK(round_down(200.0) == doctest::Approx(200.0));
}

}  // namespace bowstring::testing
