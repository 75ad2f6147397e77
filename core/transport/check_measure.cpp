#include "core/transport/check_measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/composition/tree.hpp"

namespace bowstring {
namespace {

constexpr double rotation_tolerance = 1e-6;

void check_sizes(const Measure& measure, std::vector<MeasureFlaw>& flaws) {
  const std::size_t count = measure.count();
  if (measure.position.size() != 3 * count) {
    flaws.push_back(
        {-1, std::to_string(measure.position.size()) + " coordinates", "three for each place", "add the missing ones"});
  }
  if (measure.weight.size() != count) {
    flaws.push_back({-1, std::to_string(measure.weight.size()) + " weights for " + std::to_string(count) + " places",
                     "one for each place", "give every place its weight"});
  }
  if (measure.has_frames() && measure.orientation.size() != 4 * count) {
    flaws.push_back({-1,
                     std::to_string(measure.orientation.size()) + " numbers of orientations for " +
                         std::to_string(count) + " places",
                     "a quaternion w, x, y, z for each place, or none at all", "give every place its orientation"});
  }
}

void check_place(const Measure& measure, std::size_t i, std::vector<MeasureFlaw>& flaws) {
  const long index = static_cast<long>(i);
  if (!std::all_of(&measure.position[3 * i], &measure.position[3 * i] + 3, [](double x) { return std::isfinite(x); })) {
    flaws.push_back(
        {index, "a position that is not finite", "three finite numbers in mm", "leave the place out or mend it"});
  }
  const double weight = measure.weight[i];
  if (!std::isfinite(weight) || weight < 0.0) {
    flaws.push_back(
        {index, "weight " + decimal(weight), "a finite number, not negative", "leave the place out or mend it"});
  }
  if (!measure.has_frames()) return;
  const double* q = &measure.orientation[4 * i];
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::fabs(length - 1.0) <= rotation_tolerance)) {
    flaws.push_back({index, "a quaternion of length " + decimal(length) + ", which is no rotation", "length 1",
                     "divide it by its length"});
  }
}

}  // namespace

std::vector<MeasureFlaw> flaws_of(const Measure& measure) {
  std::vector<MeasureFlaw> flaws;
  if (measure.position.empty()) {
    flaws.push_back({-1, "no places", "at least one", "add a place"});
    return flaws;
  }
  check_sizes(measure, flaws);
  if (!flaws.empty()) return flaws;
  for (std::size_t i = 0; i < measure.count(); ++i) check_place(measure, i, flaws);
  if (flaws.empty() && *std::max_element(measure.weight.begin(), measure.weight.end()) <= 0.0) {
    flaws.push_back({-1, "weights that are all zero", "at least one above zero", "give the places their weights"});
  }
  return flaws;
}

std::string sum_mismatch(const std::vector<double>& weight_a, const std::vector<double>& weight_b) {
  double a = 0.0, b = 0.0;
  for (const double weight : weight_a) a += weight;
  for (const double weight : weight_b) b += weight;
  if (std::fabs(a - b) <= weight_sum_tolerance * std::max(a, b)) return "";
  char text[120];
  std::snprintf(text, sizeof text, "the weights of the first measure sum to %.12g, those of the second to %.12g", a, b);
  return text;
}

std::vector<double> uniform_weights(std::size_t count) {
  return std::vector<double>(count, 1.0 / static_cast<double>(count));
}

}  // namespace bowstring
