#pragma once

#include <string>
#include <vector>

#include "study/study_data.hpp"

namespace bowstring::study {

struct SensitivityEntry {
  int axis = 0;
  double at = 0.0;          ///< p: the parameter's value at the place
  double derivative = 0.0;  ///< ∂q/∂p, per unit of the axis
  double elasticity = 0.0;  ///< (p/q) ∂q/∂p; NaN where q is 0
};

/// What one quantity feels of the parameters at one place.
struct Sensitivity {
  int quantity = 0;
  std::string at;  ///< "T = 10 N, EI = 65 N mm^2", "the middle of the sample"
  std::vector<SensitivityEntry> entries;
};

/// On grids: at every converged run whose neighbours along an axis of three or more numbers have converged, the
/// derivative of the parabola through the three values, at unequal spacing; along a logarithmic axis the parabola is in
/// ln p. Of a sample: the coefficients of a linear fit, where it explains 70 % of the variance. On the finest mesh
/// only.
std::vector<Sensitivity> find_sensitivities(const StudyData& data);

/// Two parameters that the quantities cannot tell apart.
struct Inseparable {
  int axes[2] = {0, 0};
  double cosine = 0.0;
  std::string text;
};

/// The columns of the sensitivity matrix: a row for each quantity at each place, p ∂q/∂p over the quantity's standard
/// deviation in the study (p stands for the axis's own deviation where its numbers are not all of one sign). Two
/// parameters whose columns have |cosine| > 0.98 over the rows they share, two at least, change the quantities in the
/// same proportions; the closest first (collinearity: Brun, Reichert, Künsch, Water Resour. Res. 37:1015, 2001).
std::vector<Inseparable> find_inseparable(const StudyData& data, const std::vector<Sensitivity>& sensitivities);

}  // namespace bowstring::study
