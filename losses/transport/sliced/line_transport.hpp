#pragma once

#include <cstddef>
#include <vector>

#include "core/interfaces/span.hpp"

namespace bowstring::sliced {

/// Weighted points of a line, in increasing order.
struct LineMeasure {
  std::vector<int> place;        ///< which place of the measure each one is; those without mass too
  std::vector<double> position;  ///< increasing; of equal ones the earlier place comes first
  std::vector<double> mass;
};

/// `position`, `mass`: one per place.
LineMeasure sorted(Span<const double> position, Span<const double> mass);

/// Mass that goes from the i-th to the j-th point of sorted measures.
struct LineStep {
  std::size_t i = 0, j = 0;
  double mass = 0.0;
};

/// The optimal plan between measures of equal mass on a line under (p − q)²: monotone, and so the staircase that takes
/// both in their order (G. Monge's condition; C. Villani, Topics in Optimal Transportation (2003), 2.2). Every point
/// stands in it, those without mass with steps of mass 0; consecutive steps share i or j.
std::vector<LineStep> staircase(const LineMeasure& a, const LineMeasure& b);

/// Potentials u, v by place with u_i + v_j ≤ (p_i − q_j)² everywhere and equality on the staircase.
void staircase_potentials(const LineMeasure& a, const LineMeasure& b, const std::vector<LineStep>& steps,
                          std::vector<double>& u, std::vector<double>& v);

}  // namespace bowstring::sliced
