// Any text as a measure: of places, of a curve through them, of a result's curve. It is read and has no flaw, or every
// reason why not is a sentence.

#include <cmath>
#include <string>

#include "core/composition/composition.hpp"
#include "core/measure/given_measure.hpp"
#include "core/transport/check_measure.hpp"
#include "tests/fuzz/scratch.hpp"

namespace {

using namespace bowstring;

void check(const CurveMeasure& measure, bool is_curve) {
  fuzz::require(flaws_of(measure.measure).empty(), "a measure with a flaw");
  fuzz::require(measure.arc.size() == (is_curve ? measure.measure.count() : 0), "arc lengths of another number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const bool utf8 = fuzz::is_utf8(text);
  const CurveSampling samplings[] = {
      {}, {0, CurveWeights::lumen_section, {}}, {3, CurveWeights::arc_length, {{1.0, 2.0, 3.0}}}};
  for (const MeasureName& name : {MeasureName{"m", ""}, MeasureName{"m", "curve"}}) {
    std::vector<InputError> errors;
    const auto given = read_given_measure(name, text, errors);
    fuzz::require(given.has_value() == errors.empty(), "a refusal without a reason, or a reason without a refusal");
    for (const CurveSampling& sampling : samplings) {
      if (!given) break;
      std::vector<InputError> why;
      const auto measure = measure_of(*given, sampling, true, why);
      fuzz::require(measure.has_value() == why.empty(), "a refusal without a reason, or a reason without a refusal");
      if (measure) check(*measure, given->is_curve);
      errors.insert(errors.end(), why.begin(), why.end());
    }
    for (const InputError& error : errors) {
      fuzz::require(!error.found.empty(), "an error without a text");
      fuzz::require(!utf8 || fuzz::is_utf8(error.text()), "an error that cuts a letter");
    }
  }
  return 0;
}
