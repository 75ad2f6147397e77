#include "study/analysis/analysis.hpp"

#include "study/analysis/headlines.hpp"

namespace bowstring::study {

const char* headline_kind_name(HeadlineKind kind) noexcept {
  switch (kind) {
    case HeadlineKind::recommendation:
      return "recommendation";
    case HeadlineKind::convergence:
      return "convergence";
    case HeadlineKind::effect:
      return "effect";
    case HeadlineKind::warning:
      return "warning";
    case HeadlineKind::failures:
      return "failures";
  }
  return "";
}

Analysis analyse(const StudyData& data) {
  Analysis out;
  if (data.runs.empty()) return out;
  out.lines = find_lines(data);
  out.recommendation = recommend(data);
  out.effects = find_effects(data);
  out.sensitivities = find_sensitivities(data);
  out.inseparable = find_inseparable(data, out.sensitivities);
  out.distributions = find_distributions(data);
  out.headlines = write_headlines(data, out);
  return out;
}

}  // namespace bowstring::study
