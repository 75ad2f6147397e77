#pragma once

#include "study/plan/plan.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// Gives every quantity its reference, run by run, as the study's [reference] says: of runs, only those that converged
/// are one.
void add_references(const Plan& plan, StudyData& data);

}  // namespace bowstring::study
