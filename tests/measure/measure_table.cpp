#include "core/measure/measure_table.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace bowstring;

namespace {

MeasureTable good(const std::string& text) {
  std::vector<InputError> errors;
  MeasureTable out = read_measure_table(text, "m.csv", errors);
  for (const InputError& error : errors) FAIL(error.text());
  return out;
}

std::string errors_of(const std::string& text) {
  std::vector<InputError> errors;
  read_measure_table(text, "m.csv", errors);
  std::string out;
  for (const InputError& error : errors) out += error.text() + "\n";
  return out;
}

}  // namespace

TEST_CASE("columns in any order, comments, byte order marks, line ends of other systems") {
  const MeasureTable table = good(
      "\xEF\xBB\xBF# a file\r\n\r\n z_mm , x_mm,y_mm,weight,name,radius_mm\r\n3,1,2,0.25,first,5\r\n# "
      "no\r\n6,4,5,0.75,,6");
  CHECK(table.measure.position == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(table.measure.weight == std::vector<double>{0.25, 0.75});
  CHECK(table.has_weights);
  CHECK(table.radius == std::vector<double>{5, 6});
  CHECK_FALSE(table.measure.has_frames());
}

TEST_CASE("without a column of weights every place has the same") {
  const MeasureTable table = good("x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n2,0,0\n3,0,0\n");
  CHECK(table.measure.weight == std::vector<double>(4, 0.25));
  CHECK_FALSE(table.has_weights);
  CHECK(table.radius.empty());
}

TEST_CASE("quaternions whose digits are cut off come out with length 1") {
  const MeasureTable table = good("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,0.7071068,0.7071068,0,0\n");
  REQUIRE(table.measure.orientation.size() == 4);
  CHECK(std::hypot(table.measure.orientation[0], table.measure.orientation[1]) == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(table.measure.orientation[0] == doctest::Approx(std::sqrt(0.5)));
}

TEST_CASE("everything that is wrong with a file at once, by line and place") {
  CHECK(
      errors_of("x_mm,y_mm,z_mm,qw,qx,qy,qz,weight\n"
                "0,0,0,1,0,0,0,1\n"
                "0,0,1,0,0,0\n"
                "0,,1,1,0,0,0,1\n"
                "# a comment\n"
                "0,abc,1,1,0,0,0,1\n"
                "0,0,1,1,0,0,0,-2\n"
                "0,0,1,1,0,0,0,nan\n"
                "0,0,inf,1,0,0,0,1\n"
                "0,0,1,0.5,0,0,0,1\n"
                "0,0,1,1,0,0,0,1,9\n") ==
      "m.csv:3: place 1: a row of 6 cells; expected 8, one for each column that the header names; complete the row or "
      "remove it\n"
      "m.csv:4: place 2: an empty cell in column 'y_mm'; expected a number, as 12.5; correct the cell or remove the "
      "row\n"
      "m.csv:6: place 3: 'abc' in column 'y_mm' is no number; expected a number, as 12.5; correct the cell or remove "
      "the row\n"
      "m.csv:7: place 4: weight -2; expected a finite number, not negative; leave the place out or mend it\n"
      "m.csv:8: place 5: weight nan; expected a finite number, not negative; leave the place out or mend it\n"
      "m.csv:9: place 6: 'inf' in column 'z_mm'; expected a finite number; correct the cell or remove the row\n"
      "m.csv:10: place 7: a quaternion of length 0.5, which is no rotation; expected length 1; divide it by its "
      "length\n"
      "m.csv:11: place 8: a row of 9 cells; expected 8, one for each column that the header names; remove what is too "
      "much, or name it\n");
}

TEST_CASE("files that hold no measure") {
  const std::string columns = "expected x_mm,y_mm,z_mm[,qw,qx,qy,qz][,weight][,any point data]; ";
  CHECK(errors_of("") == "m.csv: no line names the columns; " + columns + "give a header and a row for each place\n");
  CHECK(errors_of("# nothing\n\n") ==
        "m.csv: no line names the columns; " + columns + "give a header and a row for each place\n");
  CHECK(errors_of("x_mm,y_mm,z_mm\n") == "m.csv: no places; expected at least one; give a row for each place\n");
  CHECK(errors_of("x_mm,y_mm,z_mm,weight\n0,0,0,0\n1,0,0,0\n") ==
        "m.csv: weights that are all zero; expected at least one above zero; give the places their weights\n");
  CHECK(errors_of("1,2,3\n4,5,6\n") == "m.csv:1: numbers where the columns' names belong; " + columns +
                                           "put a line with the names before the places\n");
}

TEST_CASE("columns that are missing, partial, doubled or nearly right") {
  const std::string columns = "expected x_mm,y_mm,z_mm[,qw,qx,qy,qz][,weight][,any point data]; ";
  CHECK(errors_of("x_mm,y_mm\n0,0\n") ==
        "m.csv:1: no column 'z_mm' among x_mm,y_mm; " + columns + "add a column z_mm, 0 for places in the plane\n");
  CHECK(errors_of("x,y_mm,z_mm\n0,0,0\n") ==
        "m.csv:1: no column 'x_mm' among x,y_mm,z_mm; " + columns + "rename 'x' if it is in mm\n");
  CHECK(errors_of("x_mm;y_mm;z_mm\n").find("separate the columns by commas") != std::string::npos);
  CHECK(errors_of("x_mm,y_mm,z_mm,qw,qy\n0,0,0,1,0\n") ==
        "m.csv:1: columns qw, qy without qx, qz; expected all of qw, qx, qy, qz, or none; add the missing columns, or "
        "remove the others\n");
  CHECK(errors_of("x_mm,y_mm,z_mm,x_mm\n0,0,0,1\n") ==
        "m.csv:1: column 'x_mm' stands there twice; expected every name once; rename or remove one of them\n");
  CHECK(errors_of("x_mm,y_mm,z_mm,\n0,0,0,1\n") ==
        "m.csv:1: column 4 has no name; expected a name for every column; name it or remove the comma\n");
  for (const char* name : {"weights", "Weight", "wieght"}) {
    CAPTURE(name);
    CHECK(errors_of("x_mm,y_mm,z_mm," + std::string(name) + "\n0,0,0,1\n") ==
          "m.csv:1: column '" + std::string(name) + "', which would be left out; " + columns +
              "rename it to 'weight', or to what is not so like it\n");
  }
  CHECK(errors_of("x_mm,y_mm,z_mm,QW\n0,0,0,1\n").find("rename it to 'qw'") != std::string::npos);
  CHECK(errors_of("x_mm,y_mm,z_mm,height,hounsfield,width_mm\n0,0,0,1,2,3\n") == "");
}

TEST_CASE("of many errors the first fifty are told") {
  std::string text = "x_mm,y_mm,z_mm\n";
  for (int i = 0; i < 60; ++i) text += "a,0,0\n";
  const std::string errors = errors_of(text);
  CHECK(errors.find("m.csv:51: ") != std::string::npos);
  CHECK(errors.find("m.csv:52: ") == std::string::npos);
  CHECK(errors.find("m.csv: and 10 more errors\n") != std::string::npos);
}
