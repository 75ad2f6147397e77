#include <doctest/doctest.h>

#include "tests/writers/small_result.hpp"

namespace bowstring::testing {

TEST_CASE("vtp: a result without what the file needs is refused with words") {
  const std::string mend = "; look at the document's status and reason";
  const std::string good = small_result(2);
  REQUIRE(written("vtp", good).good);
  const auto refusal = [&](const std::string& word, const std::string& by) {
    const Written result = written("vtp", edited_result(good, word, by));
    CHECK_FALSE(result.good);
    return result.text;
  };
  CHECK(refusal("[50, 2]", "[50, null]") == "curves[0].points[1]: found null, expected finite coordinates" + mend);
  CHECK(refusal("[50, 0]", "[null, 0]") ==
        "curves[0].reference_points[1]: found null, expected finite coordinates" + mend);
  CHECK(refusal("[[1, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]]", "[]") ==
        "curves[0].frames[0]: found none, expected a unit quaternion at every node" + mend);
  CHECK(refusal("[[0, 1, 0, 0], ", "[[0, 2, 0, 0], ") ==
        "curves[1].frames[0]: found a quaternion of length 2.000000, expected a unit quaternion" + mend);
  CHECK(refusal("[6, 5, 6]", "[6, null, 6]") ==
        "curves[0].radius_mm[1]: found null, expected a radius at every node, or at none" + mend);
  CHECK(refusal("[6, 5, 6]", "[6, 5, 0]") ==
        "curves[0].radius_mm[2]: found 0.000000, expected a radius above 0" + mend);
  CHECK(refusal("\"t\": 0.75", "\"t\": null") ==
        "contacts[1]: found no wire_edge or no t, expected the contact's place on its wire" + mend);
  CHECK(refusal("\"t\": 0.75", "\"t\": 2.5") ==
        "contacts[1]: found wire_edge + t = 3.500000, expected a place on its wire, from 0 to 3" + mend);
}

}  // namespace bowstring::testing
