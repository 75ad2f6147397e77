#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/measure/curve_measure.hpp"

namespace bowstring {

struct InputError;

/// The State 2 of one curve of a `bowstring.result/1` document, with its radii where they are known; a scene in the
/// plane has z = 0. `file` is what messages call the document. What is wrong goes into `errors`; then the answer is
/// empty.
std::optional<NodalCurve> read_result_curve(const std::string& text, const std::string& file, const std::string& curve,
                                            std::vector<InputError>& errors);

}  // namespace bowstring
