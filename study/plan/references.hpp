#pragma once

#include <string>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "study/plan/study_file.hpp"

namespace bowstring::study {

/// Reads [reference]; null: none. `study` has its axes and quantities already.
Reference read_reference(const Entry* entry, const StudyFile& study, Report& report);

/// The value of a closed form where the axes have these numbers (NaN: the axis has none). `why` says what is wrong with
/// the expression; then NaN. The grammar is muParser's: + - * / ^, functions, `_pi`, and the axes by their names.
double evaluate(const std::string& expression, const StudyFile& study, const std::vector<double>& numbers,
                std::string& why);

}  // namespace bowstring::study
