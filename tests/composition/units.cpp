#include "core/composition/units.hpp"

#include <doctest/doctest.h>

#include <string>

#include "core/composition/common_units.hpp"

using namespace bowstring;

namespace {

struct Row {
  const char* from;
  const char* to;
  double factor;
};

constexpr double pi = 3.14159265358979323846;

constexpr Row common[] = {
    {"mm", "mm", 1.0},          {"cm", "mm", 10.0},
    {"m", "mm", 1000.0},        {"um", "mm", 1e-3},
    {"µm", "mm", 1e-3},         {"in", "mm", 25.4},
    {"Fr", "mm", 1.0 / 3.0},    {"N", "N", 1.0},
    {"mN", "N", 1e-3},          {"kN", "N", 1e3},
    {"deg", "rad", pi / 180.0}, {"°", "rad", pi / 180.0},
    {"rad", "deg", 180.0 / pi}, {"N mm^2", "N mm^2", 1.0},
    {"N·mm²", "N mm^2", 1.0},   {"N⋅mm²", "N mm^2", 1.0},
    {"N*mm^2", "N mm^2", 1.0},  {"N mm2", "N mm^2", 1.0},
    {"N mm**2", "N mm^2", 1.0}, {"N.mm.mm", "N mm^2", 1.0},
    {"N m^2", "N mm^2", 1e6},   {"N cm^2", "N mm^2", 100.0},
    {"N/mm", "N/mm", 1.0},      {"N / m", "N/mm", 1e-3},
    {"N m^-1", "N/mm", 1e-3},   {"N·m⁻¹", "N/mm", 1e-3},
    {"N/mm^2", "N/mm^2", 1.0},  {"N/mm/mm", "N/mm^2", 1.0},
    {"N/mm mm", "N", 1.0},      {"Pa", "N/mm^2", 1e-6},
    {"kPa", "N/mm^2", 1e-3},    {"MPa", "N/mm^2", 1.0},
    {"GPa", "N/mm^2", 1e3},     {"GPa mm^4", "N mm^2", 1e3},
    {"1/mm", "mm^-1", 1.0},     {"/mm", "1/mm", 1.0},
    {"1/m", "1/mm", 1e-3},      {"deg/mm", "rad/mm", pi / 180.0},
    {"N mm/rad", "N mm", 1.0},
};

constexpr Row by_database[] = {
    {"inch", "mm", 25.4},
    {"foot", "mm", 304.8},
    {"mmHg", "N/mm^2", 1.333223874150e-4},
    {"kgf", "N", 9.80665},
    {"N/(mm^2)", "N/mm^2", 1.0},
    {"N-mm", "N mm", 1.0},
    {"kg m/s^2", "N", 1.0},
    {"min", "s", 60.0},
    {"%", "", 0.01},
    {"turn", "rad", 2.0 * pi},
    {"ft Fr", "mm^2", 304.8 / 3.0},
    {"arcminute", "deg", 1.0 / 60.0},
};

}  // namespace

TEST_CASE("common units are converted without the database, to what UDUNITS-2 says") {
  for (const Row& row : common) {
    CAPTURE(row.from);
    CAPTURE(row.to);
    REQUIRE(read_common_unit(ascii_unit(row.from)).has_value());
    REQUIRE(read_common_unit(ascii_unit(row.to)).has_value());
    const UnitConversion fast = convert_unit(row.from, row.to);
    const UnitConversion slow = convert_unit_by_udunits(row.from, row.to);
    REQUIRE(fast.outcome == UnitOutcome::converted);
    REQUIRE(slow.outcome == UnitOutcome::converted);
    CHECK(fast(1.0) == doctest::Approx(row.factor).epsilon(1e-15));
    CHECK(slow(1.0) == doctest::Approx(fast(1.0)).epsilon(4e-15));
  }
}

TEST_CASE("the two ways agree on every pair of common units, convertible or not") {
  int converted = 0, refused = 0;
  for (const Row& a : common) {
    for (const Row& b : common) {
      CAPTURE(a.from);
      CAPTURE(b.from);
      const UnitConversion fast = convert_unit(a.from, b.from);
      const UnitConversion slow = convert_unit_by_udunits(a.from, b.from);
      REQUIRE(fast.outcome == slow.outcome);
      if (fast.outcome == UnitOutcome::converted) {
        ++converted;
        CHECK(slow(1.0) == doctest::Approx(fast(1.0)).epsilon(4e-15));
      } else {
        ++refused;
      }
    }
  }
  CHECK(converted > 100);
  CHECK(refused > 100);
}

TEST_CASE("decimal units are converted with one rounding") {
  CHECK(convert_unit("um", "mm")(3.0) == 0.003);
  CHECK(convert_unit("N/m", "N/mm")(7.0) == 0.007);
  CHECK(convert_unit("Pa", "N/mm^2")(5.0) == 5e-6);
  CHECK(convert_unit("Fr", "mm")(6.0) == 2.0);
  CHECK(convert_unit("in", "mm")(0.035) == 0.889);
}

TEST_CASE("other units are converted by UDUNITS-2") {
  for (const Row& row : by_database) {
    CAPTURE(row.from);
    REQUIRE_FALSE(read_common_unit(ascii_unit(row.from)).has_value());
    const UnitConversion conversion = convert_unit(row.from, row.to);
    REQUIRE(conversion.outcome == UnitOutcome::converted);
    CHECK(conversion(1.0) == doctest::Approx(row.factor).epsilon(1e-12));
  }
}

TEST_CASE("units of another dimension are told from units that do not exist") {
  const auto outcome = [](const char* from, const char* to) { return convert_unit(from, to).outcome; };
  CHECK(outcome("N", "mm") == UnitOutcome::other_dimension);
  CHECK(outcome("N/mm", "N/mm^2") == UnitOutcome::other_dimension);
  CHECK(outcome("N mm", "N mm^2") == UnitOutcome::other_dimension);
  CHECK(outcome("deg", "mm") == UnitOutcome::other_dimension);
  CHECK(outcome("deg", "") == UnitOutcome::other_dimension);
  CHECK(outcome("mm", "") == UnitOutcome::other_dimension);
  CHECK(outcome("kg", "N") == UnitOutcome::other_dimension);
  CHECK(outcome("inch", "1/mm") == UnitOutcome::other_dimension);
  CHECK(outcome("Nmm", "N mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("furlongs-ish", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("mm^", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("(mm", "mm") == UnitOutcome::unknown_unit);
}

TEST_CASE("offsets, logarithms and second numbers are no units") {
  const auto outcome = [](const char* from, const char* to) { return convert_unit(from, to).outcome; };
  CHECK(outcome("mm @ 3", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("degC", "K") == UnitOutcome::unknown_unit);
  CHECK(outcome("lg(re 1 mm)", "mm") != UnitOutcome::converted);
  CHECK(outcome("4 mm", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("/3 mm", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("1/3 mm", "mm") == UnitOutcome::unknown_unit);
  CHECK(outcome("-mm", "mm") == UnitOutcome::unknown_unit);
}

TEST_CASE("a quantity is a number and what follows it") {
  const auto number = [](const char* text) { return split_quantity(text).value().number; };
  const auto unit = [](const char* text) { return split_quantity(text).value().unit; };
  CHECK(number("65 N mm^2") == 65.0);
  CHECK(unit("65 N mm^2") == "N mm^2");
  CHECK(number("  +1e3mm ") == 1000.0);
  CHECK(unit("  +1e3mm ") == "mm");
  CHECK(number("-.5 mm") == -0.5);
  CHECK(unit("0.2 1/mm") == "1/mm");
  CHECK(unit("3") == "");
  CHECK_FALSE(split_quantity("").has_value());
  CHECK_FALSE(split_quantity("mm").has_value());
  CHECK_FALSE(split_quantity("1e999 mm").has_value());
}
