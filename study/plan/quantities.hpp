#pragma once

#include <string>
#include <vector>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "study/plan/study_file.hpp"

namespace bowstring::study {

/// Reads `quantities`: a list of paths, or a table of columns and paths; null: the ones that every scene has.
std::vector<QuantityOfInterest> read_quantities(const Entry* entry, Report& report);

/// The column of a quantity that the study gives no name: "peak_displacement_mm", "energy_total_N_mm",
/// "losses_shape_value", "curvature_max_per_mm".
std::string default_column(const QuantityOfInterest& quantity);

/// The unit of what a path of the result document leads to, "N mm"; "" without.
std::string unit_of_path(const std::string& path);

}  // namespace bowstring::study
