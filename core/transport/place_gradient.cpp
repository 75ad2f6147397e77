#include "core/transport/place_gradient.hpp"

#include <cstddef>

#include "core/lie/so3.hpp"

namespace bowstring {
namespace {

/// Adds Σ_k coefficient_k ∂₁c(x_{first_k}, y_{second_k}) to body tangents of `x`.
Status add(const GroundCost& cost, const Measure& x, const Measure& y, const std::vector<int>& first,
           const std::vector<int>& second, const std::vector<double>& coefficient, std::vector<double>& tangent) {
  const std::size_t count = coefficient.size();
  if (count == 0) return {};
  std::vector<int> pairs(2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    pairs[2 * k] = first[k];
    pairs[2 * k + 1] = second[k];
  }
  std::vector<double> value(count), gradient(6 * count);
  const Status status = cost.evaluate(x, y, pairs, value, gradient);
  if (!status.ok()) return status;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t e = 0; e < 6; ++e) {
      tangent[6 * static_cast<std::size_t>(first[k]) + e] += coefficient[k] * gradient[6 * k + e];
    }
  }
  return {};
}

/// Both places of a cost within one measure move.
Status add_within(const GroundCost& cost, const Measure& x, const SparseEntries& by_cost,
                  std::vector<double>& tangent) {
  const Status status = add(cost, x, x, by_cost.row, by_cost.column, by_cost.value, tangent);
  return status.ok() ? add(cost, x, x, by_cost.column, by_cost.row, by_cost.value, tangent) : status;
}

/// `direct`: of a method that reads positions.
PlaceGradient finished(const Measure& x, std::vector<double> tangent, const std::vector<double>& direct) {
  PlaceGradient out;
  out.position.resize(3 * x.count());
  for (std::size_t i = 0; i < x.count(); ++i) {
    const lie::Rotation frame = x.has_frames() ? lie::Rotation::load(&x.orientation[4 * i]) : lie::Rotation();
    if (!direct.empty())
      (frame.inverse() * Vector3::load(&direct[3 * i]) + Vector3::load(&tangent[6 * i + 3])).store(&tangent[6 * i + 3]);
    (frame * Vector3::load(&tangent[6 * i + 3])).store(&out.position[3 * i]);
  }
  if (x.has_frames()) out.frame = std::move(tangent);
  return out;
}

}  // namespace

Status place_gradients(const GroundCost& cost, const Measure& a, const Measure& b, const TransportAnswer& answer,
                       PlaceGradient& of_a, PlaceGradient& of_b) {
  std::vector<double> tangent_a(6 * a.count(), 0.0), tangent_b(6 * b.count(), 0.0);
  const bool reads_points = !answer.position_gradient_a.empty();
  if (!reads_points) {
    const SparseEntries& between = answer.by_cost.value.empty() ? answer.plan : answer.by_cost;
    Status status = add(cost, a, b, between.row, between.column, between.value, tangent_a);
    if (status.ok()) status = add(cost, b, a, between.column, between.row, between.value, tangent_b);
    if (status.ok()) status = add_within(cost, a, answer.by_cost_within_a, tangent_a);
    if (status.ok()) status = add_within(cost, b, answer.by_cost_within_b, tangent_b);
    if (!status.ok()) return status;
  }
  of_a = finished(a, std::move(tangent_a), answer.position_gradient_a);
  of_b = finished(b, std::move(tangent_b), answer.position_gradient_b);
  return {};
}

}  // namespace bowstring
