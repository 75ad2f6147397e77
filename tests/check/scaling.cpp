#include <doctest/doctest.h>

#include "tests/check/checked_scene.hpp"

namespace bowstring::testing {

TEST_CASE("orders of magnitude stand in a table by field and by group of rows") {
  const CheckReport report = check(*session_of_file("planar-iliac-smooth.toml")->assembly);
  REQUIRE(report.fields.size() == 6);
  const FieldScale& position = report.fields[0];
  CHECK(position.curve == "iliac");
  CHECK(position.field == "position");
  CHECK(position.unknowns == 156);
  CHECK_FALSE(position.angle);
  CHECK(position.gradient > 0.0);
  const double edge = 2.3;  // mm: springs of 0.012801 N/mm² times this
  CHECK(position.smallest_diagonal == doctest::Approx(0.012801 * edge).epsilon(0.05));
  CHECK(report.fields[1].angle);
  REQUIRE(report.row_groups.size() == 3);
  const RowScale& closure = report.row_groups[0];
  CHECK(closure.name == "edge closure of 'iliac'");
  CHECK(closure.rows == 158);
  CHECK(closure.active == 158);
  CHECK(closure.smallest_gradient >= 1.0);
  CHECK(closure.largest_gradient <= 2.0);
  CHECK(report.row_groups[2].name == "constraint 'lumen'");
  CHECK(report.row_groups[2].active == 0);
}

TEST_CASE("rows whose gradient vanishes at the start are counted") {
  const CheckReport report = check(*session_of_file("planar-iliac.toml")->assembly);
  CHECK(report.row_groups[2].vanishing == 78);
  const std::string text = line_of(report.scaling, "constraint 'lumen'", "rows").text;
  CHECK_MESSAGE(contains(text, "78 vanish at the start, as a squared gap does on a centerline"), text);
}

TEST_CASE("fields that are more than 1e6 apart are a note, and named") {
  const CheckReport report =
      check(*session_of_file("planar-iliac-smooth.toml", {{"energy.wire-bending.bending-stiffness", "\"1e9 N mm^2\""}})
                 ->assembly);
  const CheckLine& line = line_of(report.scaling, "unknowns", "stiffness");
  CHECK(line.verdict == CheckVerdict::note);
  CHECK_MESSAGE(contains(line.text, "of 'lunderquist'): further apart than 1e6"), line.text);
}

TEST_CASE("rows whose gradient is far from 1 are a note") {
  Rod rod;
  rod.geometry = R"(type = "arc", radius = "5000 mm", angle = "1 rad")";
  rod.more = "\n[[constraint]]\nname = \"channel\"\ntype = \"test-wrong-row-hessian\"\non = [\"rod\"]\n";
  const CheckReport report = check(*dishonest_session(rod.text())->assembly);
  const CheckLine& line = line_of(report.scaling, "constraint 'channel'", "rows");
  CHECK(line.verdict == CheckVerdict::note);
  CHECK_MESSAGE(contains(line.text, "far from 1, so that its residual is no distance"), line.text);
}

}  // namespace bowstring::testing
