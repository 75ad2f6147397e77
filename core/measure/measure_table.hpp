#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/measure.hpp"

namespace bowstring {

/// A measure file as it stands.
struct MeasureTable {
  Measure measure;             ///< weights 1/count each where the file has none
  bool has_weights = false;    ///< a column `weight`
  std::vector<double> radius;  ///< the column `radius_mm`, mm; empty without
};

/// Reads comma-separated text: lines that begin with `#` and blank lines are skipped; the first other line names the
/// columns, in any order; every row is a place. Columns x_mm, y_mm, z_mm; optionally qw, qx, qy, qz, a unit quaternion
/// whose first axis is the curve's; optionally weight. radius_mm is read where it is there; any other column is data of
/// the point, which transport has no use for, but a name that was probably meant to be one of these is an error:
/// weights that are silently left out would be a wrong number.
///
/// `name` is what messages call the file. Everything that is wrong goes into `errors`, by line and by the place's index
/// from 0; then the answer is not to be used.
MeasureTable read_measure_table(std::string_view text, const std::string& name, std::vector<InputError>& errors);

}  // namespace bowstring
