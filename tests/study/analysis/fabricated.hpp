#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study_data.hpp"

namespace bowstring::testing {

study::AxisData words_axis(const std::string& name, const std::vector<std::string>& labels);
study::AxisData number_axis(const std::string& name, const std::vector<double>& numbers, const std::string& unit = "",
                            study::Spacing spacing = study::Spacing::listed);

/// A study without runs; its quantities have no values yet.
study::StudyData study_of(const std::vector<study::AxisData>& axes, const std::vector<std::string>& quantities);

/// The product of all axes, the last one fastest; sampled axes count as one and come last. All runs converged, in one
/// second, without values.
void add_product(study::StudyData& data);

/// One converged run.
int add_run(study::StudyData& data, const std::vector<int>& choice);

/// Fills a quantity from the axes' numbers and alternatives.
using ValueOf = std::function<double(const study::StudyData&, const study::RunData&)>;
void fill(study::StudyData& data, int quantity, const ValueOf& value);

/// The number that a run has on an axis.
double number(const study::StudyData& data, const study::RunData& run, int axis);

void fail(study::StudyData& data, int run, const std::string& status = "stalled",
          const std::string& reason = "no step");

/// The same reference for all runs.
void refer(study::StudyData& data, int quantity, double reference);

/// Radical inverse: point k of Halton's sequence in a base.
double halton(int k, int base);

/// A sample of two parameters, a in [1, 3] and b in [2, 4].
study::StudyData sample_of_two(int count, const std::vector<std::string>& quantities);

/// {per-length, per-node} × {same-index, node-wise, segment-wise} × N = 20…640: per length settles at 9.75 with
/// order 2, per node drifts as N^−0.46; the reference is 9.75.
study::StudyData anchoring_study();

}  // namespace bowstring::testing
