#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/curve/temporary_file.hpp"
#include "tests/geometry/built_geometry.hpp"

namespace {

using namespace bowstring::testing;
using doctest::Approx;

const double pi = std::acos(-1.0);

std::string reading(const std::string& path, const std::string& keys) { return "file = \"" + path + "\"\n" + keys; }

/// Half a circle of radius 20 about the origin at the angles 0 … π, with a radius that grows along it.
std::string half_circle(int points, double noise) {
  std::ostringstream text;
  text.precision(17);
  text << "x_mm,y_mm,z_mm,radius_mm,label\n";
  for (int i = 0; i < points; ++i) {
    const double phase = pi * i / (points - 1);
    const double distance = 20.0 + noise * std::cos(7.0 * i);
    text << distance * std::cos(phase) << ',' << distance * std::sin(phase) << ',' << noise * std::sin(5.0 * i) << ','
         << 4.0 + phase << ',' << (2 * i < points ? "first" : "second") << '\n';
  }
  return text.str();
}

TEST_CASE("without nodes and smoothing the points stand as they are") {
  const TemporaryFile file("x_mm,y_mm,z_mm,radius_mm,segment\n1,2,3,5,a\n2,4,6,5.5,a\n3,4,5,6,b\n");
  const BuiltGeometry lps = built("csv", reading(file.path(), ""), 3);
  CHECK(lps.curve.points == std::vector<double>{1, 2, 3, 2, 4, 6, 3, 4, 5});
  REQUIRE(lps.curve.data.size() == 1);
  CHECK(lps.curve.data[0].name == "radius_mm");
  CHECK(lps.curve.data[0].value == std::vector<double>{5, 5.5, 6});
  CHECK(lps.curve.label == std::vector<std::string>{"a", "a", "b"});
  CHECK(lps.curve.first_tangent.empty());
  const BuiltGeometry ras = built("csv", reading(file.path(), "coordinates = \"RAS\""), 3);
  CHECK(ras.curve.points == std::vector<double>{-1, -2, 3, -2, -4, 6, -3, -4, 5});
}

TEST_CASE("with nodes a spline through the points is sampled uniformly in arc length") {
  const TemporaryFile file(half_circle(25, 0.0));
  for (const std::string degree : {"3", "5"}) {
    const BuiltGeometry curve = built("csv", reading(file.path(), "nodes = 101\nsmoothing-degree = " + degree), 3);
    REQUIRE(curve.nodes() == 101);
    for (int i = 0; i < 101; ++i) {
      const double phase = pi * i / 100.0;
      CAPTURE(i);
      CHECK(std::abs(curve.at(i, 0) - 20.0 * std::cos(phase)) < (degree == "5" ? 2e-6 : 1e-3));
      CHECK(std::abs(curve.at(i, 1) - 20.0 * std::sin(phase)) < (degree == "5" ? 2e-6 : 1e-3));
      CHECK(std::abs(curve.curve.data[0].value[static_cast<std::size_t>(i)] - 4.0 - phase) < 1e-4);
      // The labels of the points change between 12/24 and 13/24 of the way.
      CHECK(curve.curve.label[static_cast<std::size_t>(i)] == std::string(i <= 52 ? "first" : "second"));
    }
    CHECK(unevenness(curve) < (degree == "5" ? 1e-6 : 1e-4));
    CHECK(tangent_error(curve) < 1e-3);
    CHECK(curve.curve.first_tangent[1] == Approx(1.0).epsilon(1e-4));
  }
}

TEST_CASE("smoothing leaves its distance and keeps the number of points, data and labels") {
  const TemporaryFile file(half_circle(60, 0.5));
  const BuiltGeometry raw = built("csv", reading(file.path(), ""), 3);
  const BuiltGeometry smooth = built("csv", reading(file.path(), "smoothing = \"0.45 mm\""), 3);
  REQUIRE(smooth.nodes() == 60);
  double square = 0.0;
  double from_circle = 0.0;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 3; ++k) square += std::pow(smooth.at(i, k) - raw.at(i, k), 2);
    from_circle += std::pow(std::hypot(smooth.at(i, 0), smooth.at(i, 1)) - 20.0, 2) + std::pow(smooth.at(i, 2), 2);
  }
  CHECK(std::sqrt(square / 60.0) == Approx(0.45).epsilon(1e-8));
  CHECK(std::sqrt(from_circle / 60.0) < 0.25);  // the points: 0.5
  CHECK(smooth.curve.data[0].value == raw.curve.data[0].value);
  CHECK(smooth.curve.label == raw.curve.label);
  CHECK(std::hypot(smooth.curve.first_tangent[0], smooth.curve.first_tangent[1], smooth.curve.first_tangent[2]) ==
        Approx(1.0).epsilon(1e-14));
  CHECK(smooth.warnings.empty());
}

TEST_CASE("in the plane two coordinates are enough") {
  const TemporaryFile file("y_mm,x_mm\n0,0\n1,10\n0,20\n-1,30\n0,40\n1,50\n");
  const BuiltGeometry curve = built("csv", reading(file.path(), "nodes = 11"), 2);
  CHECK(curve.nodes() == 11);
  CHECK(curve.at(0, 0) == 0.0);
  CHECK(curve.at(10, 0) == 50.0);
  CHECK(curve.curve.first_tangent.size() == 2);
}

TEST_CASE("more smoothing than a polynomial leaves is said") {
  const TemporaryFile file("x_mm,y_mm\n0,0\n10,1\n20,0\n30,-1\n40,0\n50,1\n60,0\n70,-1\n");
  const BuiltGeometry curve = built("csv", reading(file.path(), "smoothing = 30"), 2);
  REQUIRE(curve.warnings.size() == 1);
  const std::string warning = file.anonymous(curve.warnings[0]);
  CHECK(warning.find("F: smoothing 30 mm is more than the 0.") == 0);
  CHECK(warning.find(" mm that a single polynomial of degree 5 leaves; that polynomial is used; a smaller smoothing "
                     "keeps more of the curve") != std::string::npos);
}

TEST_CASE("errors of the file and of the keys are named") {
  const TemporaryFile broken("x_mm,y_mm\n0,0\n1\n2,b\n3,0\n");
  const BuiltGeometry refused = build_geometry("csv", reading(broken.path(), ""), 2);
  CHECK(refused.status.code == bowstring::Code::invalid_input);
  CHECK(broken.anonymous(refused.status.text) ==
        "F:3: a row of 1 cell; expected 2, one for each column that the header names; complete the row or "
        "remove it\n"
        "F:4: 'b' in column 'y_mm' is no number; expected a number in mm, as 12.5; correct the cell or "
        "remove the row");
  const TemporaryFile five("x_mm,y_mm\n0,0\n1,0\n2,0\n3,1\n4,1\n");
  CHECK(five.anonymous(build_geometry("csv", reading(five.path(), "nodes = 9"), 2).status.text) ==
        "F: 5 points; expected at least 6 for a spline of degree 5; set smoothing-degree = 3, or leave out "
        "'nodes' and 'smoothing'");
  const TemporaryFile three("x_mm,y_mm\n0,0\n1,0\n2,1\n");
  CHECK(three.anonymous(
            build_geometry("csv", reading(three.path(), "smoothing = 0.1\nsmoothing-degree = 3"), 2).status.text) ==
        "F: 3 points; expected at least 4 for a spline of degree 3; add rows, or leave out 'nodes' and "
        "'smoothing'");
  CHECK(build_geometry("csv", reading(three.path(), "smoothing-degree = 4"), 2).status.text ==
        "geometry 'csv': 'smoothing-degree' is 4; expected 3 or 5; give one of them");
}

const char* const data_folder = std::getenv("BOWSTRING_DATA");
const bool no_data = data_folder == nullptr;

TEST_CASE("the real artery needs BOWSTRING_DATA") {
  if (no_data) MESSAGE("BOWSTRING_DATA is not set: the checks of a real artery's centerline are skipped");
}

/// Tightest bend and largest radius times curvature, by the circle through three neighbouring nodes.
struct Bends {
  double tightest = 1e300, fold = 0.0;
};

Bends bends(const BuiltGeometry& curve) {
  Bends found;
  for (int i = 1; i + 1 < curve.nodes(); ++i) {
    double a[3], b[3];
    for (int k = 0; k < 3; ++k) {
      a[k] = curve.at(i, k) - curve.at(i - 1, k);
      b[k] = curve.at(i + 1, k) - curve.at(i, k);
    }
    const double twice_area =
        std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    const double chord = std::hypot(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
    const double curvature = 2.0 * twice_area / (curve.edge(i - 1) * curve.edge(i) * chord);
    found.tightest = std::min(found.tightest, 1.0 / curvature);
    found.fold = std::max(found.fold, curvature * curve.curve.data[0].value[static_cast<std::size_t>(i)]);
  }
  return found;
}

TEST_CASE("a real artery, smoothed: length and bends" * doctest::skip(no_data)) {
  const std::string path = std::string(data_folder) + "/vmr_0110/left_iliofemoral_to_aorta.csv";
  const auto smoothed = [&](const std::string& distance) {
    return built("csv", reading(path, "coordinates = \"RAS\"\nnodes = 2000\nsmoothing = " + distance), 3);
  };
  struct Expected {
    const char* distance;
    double tightest, fold;
  };
  for (const Expected expected : {Expected{"0.2", 8.58, 0.676}, {"0.3", 9.38, 0.581}, {"0.5", 12.32, 0.761}}) {
    const BuiltGeometry curve = smoothed(expected.distance);
    const Bends found = bends(curve);
    CAPTURE(expected.distance);
    CHECK(found.tightest == Approx(expected.tightest).epsilon(0.002));
    CHECK(found.fold == Approx(expected.fold).epsilon(0.005));
  }
  const BuiltGeometry raw = built("csv", reading(path, "coordinates = \"RAS\""), 3);
  CHECK(raw.nodes() == 300);
  CHECK(raw.length() == Approx(501.6).epsilon(1e-4));
  CHECK(bends(raw).tightest < 4.0);
}

TEST_CASE("a real artery, smoothed: the same curve as FITPACK's" * doctest::skip(no_data)) {
  const std::string folder = std::string(data_folder) + "/vmr_0110/";
  const BuiltGeometry curve = built(
      "csv",
      reading(folder + "left_iliofemoral_to_aorta.csv", "coordinates = \"RAS\"\nnodes = 200\nsmoothing = \"0.3 mm\""),
      3);
  const BuiltGeometry reference = built("csv", reading(folder + "left_smoothed_200.csv", ""), 3);
  REQUIRE(reference.nodes() == 200);
  double farthest = 0.0;
  for (int i = 0; i < 200; ++i) {
    farthest = std::max(farthest, std::hypot(curve.at(i, 0) - reference.at(i, 0), curve.at(i, 1) - reference.at(i, 1),
                                             curve.at(i, 2) - reference.at(i, 2)));
  }
  CHECK(farthest < 1e-3);
  const double held[3] = {-0.492142416654365, 0.386515454003037, 0.78000105483674};
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(curve.curve.first_tangent[k] - held[k]) < 1e-4);
}

}  // namespace
