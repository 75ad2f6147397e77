#pragma once

#include <vector>

#include "study/analysis/analysis.hpp"

namespace bowstring::study {

/// From the other parts of an analysis. In this order: which formulation to use; what keeps the first quantity from
/// converging; the largest effect on it, its distribution or the parameter that it follows most; parameters that act
/// alike; runs that came out invalid; failures and what they have in common. Where that is more than five the effect
/// gives way.
std::vector<Headline> write_headlines(const StudyData& data, const Analysis& analysis);

}  // namespace bowstring::study
