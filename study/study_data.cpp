#include "study/study_data.hpp"

namespace bowstring::study {

const char* spacing_name(Spacing spacing) noexcept {
  switch (spacing) {
    case Spacing::listed:
      return "listed";
    case Spacing::linear:
      return "linear";
    case Spacing::logarithmic:
      return "log";
    case Spacing::sampled:
      return "sampled";
  }
  return "";
}

}  // namespace bowstring::study
