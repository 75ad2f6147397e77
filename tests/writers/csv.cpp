#include <doctest/doctest.h>

#include "tests/writers/small_result.hpp"

namespace bowstring::testing {

TEST_CASE("csv: one row per node, units in the names, cells empty where nothing is known") {
  const Written plane = written("csv", small_result(2));
  REQUIRE(plane.good);
  CHECK(plane.text ==
        "# title: Small & straight\n"
        "# status: converged, all thresholds of the certificate hold\n"
        "# units: mm, 1/mm, N; x, y, z and s are State 2, reference_ is State 1\n"
        "curve,kind,node,s_mm,x_mm,y_mm,reference_x_mm,reference_y_mm,displacement_mm,radius_mm,curvature_per_mm,"
        "contact_force_N\n"
        "iliac,vessel,0,0,0,0,0,0,0,6,0,\n"
        "iliac,vessel,1,50.04,50,2,50,0,2,5,0.0016,\n"
        "iliac,vessel,2,100.08,100,0,100,0,0,6,0,\n"
        "\"wire, stiff\",wire,0,0,0,0,0,0,0,0.4,0,\n"
        "\"wire, stiff\",wire,1,30,30,0,30,0,0,0.4,0,1\n"
        "\"wire, stiff\",wire,2,70,70,0,70,0,0,0.4,0,4\n"
        "\"wire, stiff\",wire,3,100,100,0,100,0,0,0.4,,\n");
}

TEST_CASE("csv: a scene in space has three coordinates") {
  const Written space = written("csv", small_result(3));
  REQUIRE(space.good);
  CHECK(space.text.find("x_mm,y_mm,z_mm,reference_x_mm,reference_y_mm,reference_z_mm,") != std::string::npos);
  CHECK(space.text.find("iliac,vessel,1,50.04,50,2,3,50,0,3,2,5,0.0016,\n") != std::string::npos);
}

TEST_CASE("csv: contacts at one node add up; what failed or is null is empty, and never a word") {
  std::string document = edited_result(small_result(2), "\"s_mm\": 70, \"force_N\"", "\"s_mm\": 31, \"force_N\"");
  document = edited_result(document, "[50, 2]", "[50, null]");
  document = edited_result(document, "\"status\": \"converged\"", "\"status\": \"failed\"");
  document = edited_result(document, "all thresholds of the certificate hold", "two\\nlines");
  const Written table = written("csv", document);
  REQUIRE(table.good);
  CHECK(table.text.find("# status: failed, two lines\n") != std::string::npos);
  CHECK(table.text.find("\"wire, stiff\",wire,1,30,30,0,30,0,0,0.4,0,5\n") != std::string::npos);
  CHECK(table.text.find("\"wire, stiff\",wire,2,70,70,0,70,0,0,0.4,0,\n") != std::string::npos);
  CHECK(table.text.find("iliac,vessel,1,50.04,50,,50,0,,5,0.0016,\n") != std::string::npos);
  CHECK(table.text.find("nan") == std::string::npos);
}

}  // namespace bowstring::testing
