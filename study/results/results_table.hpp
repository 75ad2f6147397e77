#pragma once

#include <string>

#include "study/results/collect.hpp"

namespace bowstring::study {

/// `results.csv`: one row for each run in the order of the study, numbers in the shortest form that gives them back, an
/// unknown one empty. Only columns whose names end in `_seconds` depend on where and when the runs were solved.
std::string results_csv(const Collected& collected);

}  // namespace bowstring::study
