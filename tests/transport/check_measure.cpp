#include "core/transport/check_measure.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace bowstring;

namespace {

Measure two_frames() { return {{0, 0, 0, 1, 2, 3}, {1, 0, 0, 0, 0.6, 0.8, 0, 0}, {0.25, 0.75}}; }

std::string only_flaw(const Measure& measure) {
  const std::vector<MeasureFlaw> flaws = flaws_of(measure);
  REQUIRE(flaws.size() == 1);
  return std::to_string(flaws[0].index) + ": " + flaws[0].found + "; expected " + flaws[0].expected + "; " +
         flaws[0].mend;
}

}  // namespace

TEST_CASE("a sound measure has no flaws") {
  CHECK(flaws_of(two_frames()).empty());
  Measure points = two_frames();
  points.orientation.clear();
  CHECK(flaws_of(points).empty());
}

TEST_CASE("what is wrong with a measure, by index") {
  CHECK(only_flaw({}) == "-1: no places; expected at least one; add a place");
  Measure m = two_frames();
  m.weight[1] = -0.5;
  CHECK(only_flaw(m) == "1: weight -0.5; expected a finite number, not negative; leave the place out or mend it");
  m.weight[1] = NAN;
  CHECK(only_flaw(m) == "1: weight nan; expected a finite number, not negative; leave the place out or mend it");
  m.weight = {0.0, 0.0};
  CHECK(only_flaw(m) ==
        "-1: weights that are all zero; expected at least one above zero; give the places their weights");
  m = two_frames();
  m.orientation = {1, 0, 0, 0, 0.5, 0, 0, 0};
  CHECK(only_flaw(m) ==
        "1: a quaternion of length 0.5, which is no rotation; expected length 1; divide it by its length");
  m = two_frames();
  m.position[2] = HUGE_VAL;
  CHECK(only_flaw(m) ==
        "0: a position that is not finite; expected three finite numbers in mm; leave the place out or mend it");
  m = two_frames();
  m.weight.pop_back();
  CHECK(only_flaw(m) == "-1: 1 weights for 2 places; expected one for each place; give every place its weight");
}

TEST_CASE("sums of weights that are equal but for rounding") {
  CHECK(sum_mismatch({0.5, 0.5}, {1.0 + 1e-12}) == "");
  CHECK(sum_mismatch({0.5, 0.5}, {1.001}) == "the weights of the first measure sum to 1, those of the second to 1.001");
}
