#pragma once

#include <optional>

#include "study/analysis/analysis.hpp"

namespace bowstring::study {

/// What keeps the first quantity from settling along the axis of convergence, or how it settles; none where its lines
/// are not fitted.
std::optional<Headline> convergence_headline(const StudyData& data, const Lines& lines);

}  // namespace bowstring::study
