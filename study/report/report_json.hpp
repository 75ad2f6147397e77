#pragma once

#include <string>

#include "study/analysis/analysis.hpp"
#include "study/results/shapes.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// What the report page shows, in the format bowstring.report/1 of study/report/README.md. Equal input gives equal
/// bytes.
std::string report_json(const StudyData& data, const Analysis& analysis, const Shapes& shapes);

}  // namespace bowstring::study
