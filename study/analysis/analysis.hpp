#pragma once

#include <string>
#include <vector>

#include "study/analysis/distributions.hpp"
#include "study/analysis/effects.hpp"
#include "study/analysis/lines.hpp"
#include "study/analysis/recommendation.hpp"
#include "study/analysis/sensitivities.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

enum class HeadlineKind : int { recommendation, convergence, effect, warning, failures };
const char* headline_kind_name(HeadlineKind kind) noexcept;

/// What a report opens with, for people.
struct Headline {
  HeadlineKind kind = HeadlineKind::failures;
  std::string text;             ///< one sentence
  std::string detail;           ///< what stands behind it
  std::vector<int> lines = {};  ///< the formulations that it speaks of, by index; empty: of none in particular
};

/// What a study's results say. Runs without a value, and those that have not converged, are left out and counted; they
/// are in `lines`. The same data give the same analysis.
struct Analysis {
  Lines lines;
  Recommendation recommendation;
  Effects effects;
  std::vector<Sensitivity> sensitivities;
  std::vector<Inseparable> inseparable;
  std::vector<Distribution> distributions;
  std::vector<Headline> headlines;  ///< at most five, the most important first
};

Analysis analyse(const StudyData& data);

}  // namespace bowstring::study
