#pragma once

#include "core/interfaces/problem.hpp"

namespace bowstring::nlopt_solver {

/// What one evaluation of a chart gives. n unknowns, m rows.
struct Point {
  std::vector<double> x;         ///< n
  double energy = 0.0;           ///< N mm
  std::vector<double> gradient;  ///< n
  std::vector<double> rows;      ///< m
  std::vector<double> jacobian;  ///< in the order of the problem's pattern
};

/// How far a point is from the first-order conditions.
struct FirstOrderError {
  double stationarity = 0.0;     ///< N, largest entry of ∇E + Jᵀλ over the stationarity scale
  double violation = 0.0;        ///< mm, largest violation of a row
  double complementarity = 0.0;  ///< N mm, largest |λ_r| times the distance of row r from its bound

  double largest() const noexcept;
};

/// With the multipliers λ that make the stationarity least in the sense of squares, λ of the right sign on rows within
/// `reach` (mm) of a bound and 0 on the others. Unknowns on a bound that the gradient presses against do not count.
FirstOrderError first_order_error(const Problem& problem, const Point& point, double reach);

}  // namespace bowstring::nlopt_solver
