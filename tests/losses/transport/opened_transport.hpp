#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/transport/transport_comparison.hpp"

namespace bowstring::testing {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// A number as settings take it, to the last bit.
std::string text(double value);

TransportComparison open_transport(const std::string& method, const Settings& settings = {});
/// Everything that is wrong with them.
std::string refusal_of(const std::string& method, const Settings& settings);

/// The answer of a comparison, which has to succeed.
TransportResult compare(TransportComparison& transport, const Measure& a, const Measure& b);
TransportAnswer compare(TransportComparison& transport, const std::vector<double>& a, const std::vector<double>& b,
                        const std::vector<double>& cost);

/// The value of the same.
double value_of(TransportComparison& transport, const Measure& a, const Measure& b);

/// A number of (0, 1), the same with every library.
double uniform(std::mt19937& random);
std::vector<double> random_numbers(std::mt19937& random, std::size_t count, double low, double high);
/// Points of a cube of edge 1 mm; weights of [0.5, 1.5].
Measure random_cloud(std::mt19937& random, std::size_t count);
/// The same, drawn by a seed, with weights that sum to 1, in a cube of another edge, mm.
Measure probability_cloud(std::size_t count, unsigned seed, double edge = 1.0, bool equal_weights = false);
Measure shifted(Measure measure, double x, double y, double z);
/// The same points with orientations, of any kind.
Measure with_frames(std::mt19937& random, Measure points);

/// Σ of squares.
double squared_norm(const std::vector<double>& values);

/// That the derivatives by positions are those of differences, relative to their norms, which have to be above zero.
void check_place_gradients(TransportComparison& transport, const Measure& a, const Measure& b, double tolerance);
/// The same of weights. `together`: a weight grows as another of its measure loses (sums have to stay), else alone.
void check_weight_gradients(TransportComparison& transport, const Measure& a, const Measure& b, bool together,
                            double tolerance);

}  // namespace bowstring::testing
