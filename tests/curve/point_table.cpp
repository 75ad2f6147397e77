#include "core/curve/point_table.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/curve/temporary_file.hpp"

namespace {

using namespace bowstring;
using bowstring::testing::TemporaryFile;

/// The errors of a file with this text, its path replaced by "F"; "" where it is read.
std::string errors_of(const std::string& text, int dimension) {
  const TemporaryFile file(text);
  PointTable table;
  const Status status = read_point_table(file.path(), dimension, table);
  if (status.ok()) return "";
  CHECK(status.code == Code::invalid_input);
  CHECK(table.points.empty());
  return file.anonymous(status.text);
}

TEST_CASE("columns are read by name in any order; comments and blank lines are skipped") {
  const TemporaryFile file(
      "\xef\xbb\xbf# a comment\r\n"
      "radius_mm, z_mm ,\"y_mm\",x_mm,segment,calcium\r\n"
      "\r\n"
      "5.5,3,2,1,cia,0\r\n"
      "  # another\r\n"
      "6,6.5,+5,-4e0, cia ,0.25\r\n"
      "6,7,5,4,\"eia\",1");
  PointTable table;
  const Status status = read_point_table(file.path(), 3, table);
  REQUIRE_MESSAGE(status.ok(), status.text);
  CHECK(table.points == std::vector<double>{1, 2, 3, -4, 5, 6.5, 4, 5, 7});
  REQUIRE(table.data.size() == 2);
  CHECK(table.data[0].name == "radius_mm");
  CHECK(table.data[0].value == std::vector<double>{5.5, 6, 6});
  CHECK(table.data[1].name == "calcium");
  CHECK(table.data[1].value == std::vector<double>{0, 0.25, 1});
  CHECK(table.label == std::vector<std::string>{"cia", "cia", "eia"});
}

TEST_CASE("in the plane a column of zeros may stand for z") {
  const TemporaryFile file("x_mm,y_mm,z_mm\n0,0,0\n1,0,0.0\n2,1,-0\n");
  PointTable table;
  REQUIRE(read_point_table(file.path(), 2, table).ok());
  CHECK(table.points == std::vector<double>{0, 0, 1, 0, 2, 1});
  CHECK(table.data.empty());
  CHECK(table.label.empty());
}

TEST_CASE("all errors of a file are told at once, each with its line") {
  CHECK(errors_of("# left path\n"
                  "x_mm,y_mm,z_mm,radius_mm,calcium\n"
                  "0,0,0,5,0\n"
                  "1,0,0\n"
                  "2,0,zero,5,0\n"
                  "3,0,0,5,0,7\n"
                  "4,nan,0,-1,none\n"
                  "\n"
                  "5,0,0,,0\n"
                  "6,0,0,5,0\n"
                  "6,0,0,5,0\n",
                  3) ==
        "F:4: a row of 3 cells; expected 5, one for each column that the header names; complete the row or "
        "remove it\n"
        "F:5: 'zero' in column 'z_mm' is no number; expected a number in mm, as 12.5; correct the cell or "
        "remove the row\n"
        "F:6: a row of 6 cells; expected 5, one for each column that the header names; remove what is too "
        "much, or name it\n"
        "F:7: 'nan' in column 'y_mm'; expected a finite number in mm; correct the cell or remove the row\n"
        "F:7: radius_mm -1; expected a radius above 0 mm; correct the cell or remove the row\n"
        "F:7: 'none' in column 'calcium' is no number; expected a number, as 12.5; correct the cell; text "
        "is read from a column named 'label' or 'segment' only\n"
        "F:9: an empty cell in column 'radius_mm'; expected a number in mm, as 12.5; correct the cell or "
        "remove the row\n"
        "F:11: the point of line 10 again; expected points that are apart; remove one of the two rows");
}

TEST_CASE("a scene of the other dimension is told so") {
  CHECK(errors_of("x_mm,y_mm,z_mm\n0,0,0\n1,0,2.5\n2,0,3\n", 2) ==
        "F:3: 2-D scene with 3-D data: z_mm is 2.5 here and not 0 in 2 rows in all; expected 0 in every "
        "row, or no column z_mm; set dimension = 3 in [scene], or project the points into the plane");
  CHECK(errors_of("x_mm,y_mm\n0,0\n1,0\n2,0\n", 3) ==
        "F:1: no column 'z_mm' (3-D scene with 2-D data) among x_mm,y_mm; expected "
        "x_mm,y_mm,z_mm[,radius_mm][,any point data]; add a column z_mm (0 for a planar curve), or set "
        "dimension = 2 in [scene]");
}

TEST_CASE("a header that does not fit is told with what it has") {
  CHECK(errors_of("x,Y (mm),r\n0,0,1\n", 2) ==
        "F:1: no column 'x_mm' among x,Y (mm),r; expected x_mm,y_mm[,radius_mm][,any point data]; rename "
        "'x' if it is in mm\n"
        "F:1: no column 'y_mm' among x,Y (mm),r; expected x_mm,y_mm[,radius_mm][,any point data]; rename 'Y "
        "(mm)' if it is in mm");
  CHECK(errors_of("0,0\n1,0\n2,0\n", 2) ==
        "F:1: numbers where the columns' names belong; expected x_mm,y_mm[,radius_mm][,any point data]; put "
        "a line with the names before the points");
  CHECK(errors_of("x_mm;y_mm\n0;0\n", 2) ==
        "F:1: no column 'x_mm' among x_mm;y_mm; expected x_mm,y_mm[,radius_mm][,any point data]; separate "
        "the columns by commas\n"
        "F:1: no column 'y_mm' among x_mm;y_mm; expected x_mm,y_mm[,radius_mm][,any point data]; separate "
        "the columns by commas");
  CHECK(errors_of("x_mm,y_mm,calcium,calcium,,label,segment\n0,0,1,1,1,a,b\n", 2) ==
        "F:1: column 'calcium' stands there twice; expected every name once; rename or remove one of them\n"
        "F:1: column 5 has no name; expected a name for every column; name it or remove the comma\n"
        "F:1: both a column 'label' and a column 'segment'; expected one column of labels; remove one of them");
}

TEST_CASE("too few points, no header, no file, a folder") {
  CHECK(errors_of("x_mm,y_mm\n0,0\n1,0\n", 2) ==
        "F: 2 points; expected at least 3; add rows, in the order of the curve");
  CHECK(errors_of("# nothing\n", 2) ==
        "F: no line names the columns; expected x_mm,y_mm[,radius_mm][,any point data]; give a header and a "
        "row for each point");
  PointTable table;
  CHECK(read_point_table("/nowhere/left.csv", 3, table).text ==
        "/nowhere/left.csv: cannot be read (No such file or directory); expected a text file of points; "
        "check the path, which is relative to the composition");
  CHECK(read_point_table("/", 3, table).text ==
        "/: cannot be read (the file cannot be read to its end, or is a folder); expected a text file of "
        "points; check the path, which is relative to the composition");
}

TEST_CASE("a file full of errors is cut off") {
  std::string text = "x_mm,y_mm\n";
  for (int i = 0; i < 60; ++i) text += "0\n";
  const std::string errors = errors_of(text, 2);
  CHECK(errors.find("F:51: a row of 1 cell; expected 2") != std::string::npos);
  CHECK(errors.find("F:52:") == std::string::npos);
  CHECK(errors.substr(errors.rfind('\n')) == "\nF: and 10 more errors");
}

TEST_CASE("a long list of columns is shown in part, and no letter of it is cut") {
  std::string long_name;
  for (int i = 0; i < 60; ++i) long_name += "é";
  const std::string errors = errors_of("x_mm," + long_name + "\n", 2);
  std::string shown = " among x_mm,";
  for (int i = 0; i < 36; ++i) shown += "é";
  CHECK(errors.find(shown + "...") != std::string::npos);
}

}  // namespace
