#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "study/analysis/sample.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// How a quantity is distributed over a sample.
struct Distribution {
  static constexpr std::array<double, 5> at = {0.05, 0.25, 0.5, 0.75, 0.95};

  int quantity = 0;
  std::string label;            ///< of the sample: what it holds fixed; "" where there is one sample
  int count = 0, left_out = 0;  ///< runs with a value, and without
  double mean = 0.0, deviation = 0.0;
  std::array<double, 5> quantiles{};  ///< type 7
  std::vector<int> axes;              ///< the sampled ones
  std::vector<double> shares;         ///< of the variance, per axis; empty where no fit gives them
  double r_squared = std::numeric_limits<double>::quiet_NaN();  ///< of the fit that gives the shares
  std::string note;  ///< on the shares: what they are of, whether they add up
};

/// Per quantity and sample with a value. Shares: variances of the terms of a regression without products over the
/// variance of the quantity, which for a linear one are the squared standardised coefficients (Saltelli et al., Global
/// Sensitivity Analysis, 2008, section 1.2.5). Each parameter has a quadratic term too from ten runs for each unknown
/// of such a fit on. Where that explains less than 70 % and a linear fit of ranks explains so much, shares are of the
/// ranks.
std::vector<Distribution> find_distributions(const StudyData& data);

}  // namespace bowstring::study
