#pragma once

#include <string>
#include <vector>

#include "study/plan/plan.hpp"
#include "study/store/folder.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// All that is stored of a study, run by run.
struct Collected {
  StudyData data;
  std::vector<RunRecord> records;     ///< per run; of a refused run nothing but status and reason
  std::vector<std::string> problems;  ///< what is missing or damaged
};

Collected collect(const Plan& plan, const Folder& folder);

}  // namespace bowstring::study
