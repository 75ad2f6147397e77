#pragma once

#include <string>
#include <vector>

#include "core/interfaces/geometry.hpp"

namespace bowstring {

/// Points along a curve, as a text file gives them.
struct PointTable {
  std::vector<double> points;      ///< rows × dimension, mm, in the axes of the file
  std::vector<PointData> data;     ///< every other column of numbers, in the order of the file
  std::vector<std::string> label;  ///< the column `label` or `segment`, or empty
};

/// Reads a comma-separated file: lines that begin with `#` and blank lines are skipped; the first other line
/// names the columns, in any order; x_mm, y_mm and, in space, z_mm are the points. At least three points,
/// none of which repeats the one before; every cell but labels a finite number; radius_mm > 0; in the plane
/// z_mm may stand there as zeros.
///
/// `invalid_input`: every error of the file, one a line, as "file:line: found; expected …; how to mend it".
Status read_point_table(const std::string& file, int dimension, PointTable& out);

}  // namespace bowstring
