#pragma once

#include <string>
#include <vector>

#include "core/transport/transport_comparison.hpp"

namespace bowstring::testing {

/// A method and a cost of this build; fails the test where they cannot be had. Settings: {"epsilon", "0.1"}.
TransportComparison opened(const std::string& method, const std::vector<Override>& settings = {},
                           const std::string& cost = "euclidean");

/// The result of a comparison that has to succeed.
TransportResult compared(TransportComparison& transport, const Measure& a, const Measure& b);
double value_of(TransportComparison& transport, const Measure& a, const Measure& b);

/// A cloud of `count` points in a cube of side `size` about a shifted centre, with random weights that sum to 1.
Measure random_cloud(int count, unsigned seed, double size = 1.0, bool uniform_weights = false);

Measure shifted(Measure measure, double x, double y, double z);

/// Largest difference between the reported derivatives and central differences of the value, by points of both measures
/// and by exchanges of weight within each, relative to the largest derivative, which has to be above `least`.
double gradient_error(TransportComparison& transport, const Measure& a, const Measure& b, double step = 1e-5,
                      double least = 1e-3);

}  // namespace bowstring::testing
