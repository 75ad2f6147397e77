#pragma once

#include <string>
#include <vector>

#include "study/study_data.hpp"

namespace bowstring::study {

/// From this share of the variance on a fit speaks for the whole.
inline constexpr double enough_explained = 0.7;

/// A study's sample under one choice of its other axes, on the finest mesh.
struct Sample {
  std::string label;
  std::vector<int> axes;  ///< the sampled ones
  std::vector<int> runs;
};
/// In the order of their first runs; none without sampled axes.
std::vector<Sample> find_samples(const StudyData& data);

/// The runs of a sample in which a quantity counts.
struct SampleValues {
  std::vector<double> value;
  std::vector<std::vector<double>> parameters;  ///< per axis of the sample
};
SampleValues sample_values(const StudyData& data, const Sample& sample, int quantity);

}  // namespace bowstring::study
