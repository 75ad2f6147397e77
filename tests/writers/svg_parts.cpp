#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "writers/svg/markup.hpp"
#include "writers/svg/projection.hpp"
#include "writers/svg/symbols.hpp"
#include "writers/svg/tube.hpp"

namespace bowstring::testing {

namespace {

/// A tube of constant radius along a quarter of a circle, from (r, 0) counterclockwise.
Tube quarter(double bend_radius, double tube_radius) {
  Tube out;
  for (int k = 0; k <= 90; k += 5) {
    const double angle = k * std::acos(-1.0) / 180.0;
    out.points.push_back({{bend_radius * std::cos(angle), bend_radius * std::sin(angle)}});
    out.radius.push_back(tube_radius);
  }
  return out;
}

/// Smallest cosine between an edge of the line and the next; −1 where it turns back.
double sharpest(const Polyline& line) {
  double out = 1.0;
  for (std::size_t i = 2; i < line.size(); ++i) {
    const Vector2 before = line[i - 1] - line[i - 2], after = line[i] - line[i - 1];
    if (norm(before) > 0.0 && norm(after) > 0.0) out = std::min(out, dot(normalized(before), normalized(after)));
  }
  return out;
}

double signed_area(const Polyline& polygon) {
  double out = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) out += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return out;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("tube: the outline of a straight one is two parallels at its radius") {
  const Tube tube = refine({{{{0.0, 0.0}}, {{50.0, 0.0}}, {{100.0, 0.0}}}, {5.0, 5.0, 5.0}});
  const std::vector<Polyline> outline = tube_outline(tube);
  REQUIRE(outline.size() == 2);
  for (const Polyline& run : outline) {
    REQUIRE(run.size() >= 2);
    for (const Vector2& point : run) CHECK(std::abs(point[1]) == doctest::Approx(5.0));
  }
}

TEST_CASE("tube: the outline of a bend is two arcs, which never turn back") {
  const std::vector<Polyline> outline = tube_outline(refine(quarter(40.0, 10.0)));
  REQUIRE(outline.size() == 2);
  std::vector<double> radii;
  for (const Polyline& run : outline) {
    REQUIRE(run.size() > 10);
    radii.push_back(norm(run[run.size() / 2]));
    for (const Vector2& point : run) CHECK(norm(point) == doctest::Approx(radii.back()).epsilon(0.005));
    CHECK(sharpest(run) > 0.9);
  }
  std::sort(radii.begin(), radii.end());
  CHECK(radii[0] == doctest::Approx(30.0).epsilon(0.005));
  CHECK(radii[1] == doctest::Approx(50.0).epsilon(0.005));
}

TEST_CASE("tube: the inner outline of a bend sharper than the radius is cut where its legs meet") {
  Tube hairpin;
  for (int k = 0; k <= 10; ++k) hairpin.points.push_back({{10.0 * k, 0.0}});
  for (int k = 1; k <= 10; ++k) hairpin.points.push_back({{100.0, 10.0 * k}});
  hairpin.radius.assign(hairpin.points.size(), 20.0);
  const std::vector<Polyline> outline = tube_outline(hairpin);
  std::size_t inner = 0;
  for (const Polyline& run : outline) {
    for (const Vector2& point : run) {
      if (point[0] > 90.0 || point[1] < 10.0) continue;
      ++inner;
      CHECK((point[0] <= 80.5 && point[1] >= 19.5));
    }
  }
  CHECK(inner > 4);
}

TEST_CASE("tube: where the radius changes the outline is the common tangent of the discs, without a gap") {
  const Tube cone{{{{0.0, 0.0}}, {{20.0, 0.0}}, {{40.0, 0.0}}}, {5.0, 15.0, 25.0}};
  const std::vector<Polyline> outline = tube_outline(cone);
  REQUIRE(outline.size() == 2);
  for (const Polyline& run : outline) {
    REQUIRE(run.size() >= 2);
    const double sign = run.front()[1] > 0.0 ? 1.0 : -1.0;
    const Vector2 normal{{-0.5, sign * std::sqrt(0.75)}};  // the radius grows by half of the length
    CHECK(norm(run.back() - run.front()) > 30.0);
    for (const Vector2& point : run) CHECK(dot(point, normal) == doctest::Approx(5.0));
  }
}

TEST_CASE("tube: polygons have one orientation, and those of a straight tube or a bend have its area") {
  const auto area_of = [](const Tube& tube) {
    double sum = 0.0;
    std::size_t negative = 0, positive = 0;
    for (const Polyline& polygon : tube_area(tube)) {
      const double part = signed_area(polygon);
      ++(part < 0.0 ? negative : positive);
      sum += part;
    }
    CHECK(std::min(negative, positive) == 0);
    return std::abs(sum);
  };
  CHECK(area_of({{{{0.0, 0.0}}, {{50.0, 0.0}}}, {5.0, 5.0}}) == doctest::Approx(500.0));
  // 18 rectangles, and between them 17 sectors on the outer side; what overlaps on the inner side counts twice.
  const double degree = std::acos(-1.0) / 180.0;
  const double rectangles = 18.0 * 80.0 * std::sin(2.5 * degree) * 20.0, sectors = 17.0 * 50.0 * 5.0 * degree;
  CHECK(area_of(quarter(40.0, 10.0)) == doctest::Approx(rectangles + sectors).epsilon(1e-3));
  CHECK(area_of({{{{0.0, 0.0}}, {{20.0, 0.0}}, {{40.0, 5.0}}, {{60.0, 0.0}}}, {5.0, 15.0, 5.0, 9.0}}) > 600.0);
}

TEST_CASE("tube: coincident points, a single one and none do no harm") {
  CHECK(tube_outline(refine({})).empty());
  CHECK(tube_area(refine({{{{1.0, 2.0}}}, {3.0}})).empty());
  CHECK(tube_outline(refine({{{{1.0, 2.0}}, {{1.0, 2.0}}}, {3.0, 3.0}})).empty());
}

TEST_CASE("views: in space two orthogonal ones share their first axis, and both are right-handed") {
  Result result;
  result.dimension = 3;
  ResultCurve vessel;
  vessel.points = {{{0.0, 0.0, 0.0}}, {{50.0, 20.0, 0.0}}, {{100.0, 0.0, 5.0}}, {{150.0, 20.0, 0.0}}};
  vessel.reference = vessel.points;
  result.curves.push_back(vessel);
  const std::vector<View> views = choose_views(result);
  REQUIRE(views.size() == 2);
  CHECK(norm(views[0].right - views[1].right) < 1e-12);
  for (const View& view : views) {
    CHECK(std::abs(dot(view.right, view.up)) < 1e-12);
    CHECK(norm(view.right) == doctest::Approx(1.0));
    CHECK(norm(view.up) == doctest::Approx(1.0));
  }
  CHECK(std::abs(dot(views[0].up, views[1].up)) < 1e-12);
  CHECK(dot(views[0].right, Vector3::unit(0)) > 0.9);  // from the first point to the last
  result.dimension = 2;
  CHECK(choose_views(result).size() == 1);
}

TEST_CASE("triad: an axis along the view has a dot to the reader, and a cross away from the reader") {
  const Vector3 x = Vector3::unit(0), y = Vector3::unit(1);
  const std::string to = triad({{0.0, 0.0}}, {x, y, ""}, 3);
  CHECK(count(to, "<circle") == 2);
  CHECK(count(to, "<line") == 2);  // the other two axes
  const std::string away = triad({{0.0, 0.0}}, {-x, y, ""}, 3);
  CHECK(count(away, "<circle") == 1);
  CHECK(count(away, "<line") == 4);
  const std::string plane = triad({{0.0, 0.0}}, {x, y, ""}, 2);
  CHECK(count(plane, "<circle") == 0);
  for (const char* name : {">x<", ">y<"}) CHECK(count(plane, name) == 1);
  CHECK(count(plane, ">z<") == 0);
}

TEST_CASE("markup: text is escaped, numbers are short, lines are wrapped at blanks") {
  CHECK(escaped("a<b> & \"c\"\n\x01") == "a&lt;b&gt; &amp; &quot;c&quot;  ");
  CHECK(two_decimals(-0.001) == "0.00");
  CHECK(two_decimals(1e300).size() == 304);
  CHECK(two_decimals(std::nan("")) == "–");
  CHECK(short_number(20.0) == "20");
  CHECK(short_number(0.5) == "0.5");
  CHECK(short_number(14.3846, 4) == "14.38");
  CHECK(wrapped("one two  three", 7) == std::vector<std::string>{"one two", "three"});
  CHECK(wrapped("longerthanthat a", 5) == std::vector<std::string>{"longerthanthat", "a"});
  CHECK(wrapped("", 5).empty());
  CHECK(polyline({{{1.0, 2.0}}}, {}).empty());
}

}  // namespace bowstring::testing
