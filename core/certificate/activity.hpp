#pragma once

namespace bowstring {

/// An inequality row against the bound that its multiplier pushes away from; where that bound does not exist the
/// multiplier's sign is wrong.
struct RowSide {
  double bound = 0.0;
  double distance = 0.0;    ///< mm, from the bound, either side of it
  double multiplier = 0.0;  ///< N, > 0: pushes away from the bound
};
RowSide row_side(double lower, double upper, double value, double multiplier) noexcept;

/// `strong` rows hold like equalities to second order, `open` ones take no part. `weak`: touches and carries nothing.
/// `undecided`: neither of the two has vanished against the other yet.
enum class Activity : char { open, undecided, weak, strong };

/// With x = distance/mm and z = multiplier/N. `weak`: both at most 1e-6. `undecided`: both at most 1e-4 and neither a
/// hundred times the other, as an interior point leaves them whose barrier has not ended. Else strong where x ≤ 1e-6 or
/// z > x: of a pair with x z ≤ 1e-8, which the certificate asks for, one is at most 1e-4.
Activity activity(const RowSide& side) noexcept;

}  // namespace bowstring
