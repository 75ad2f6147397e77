#pragma once

#include <string>
#include <vector>

namespace bowstring {

/// A value that a composition gives as two ends: a number, a quantity, or a list of them.
struct ValueRange {
  std::vector<double> from, to;  ///< as many numbers; both in `unit`
  std::string unit;              ///< as the user writes it; "": bare numbers
  bool list = false;             ///< written as a list, were it of one number
  bool whole = false;            ///< whole numbers: values in between are rounded
  bool logarithmic = false;      ///< equal steps are equal ratios; both ends have one sign

  /// t = 0 is `from`, t = 1 is `to`; other t lie beyond.
  std::vector<double> at(double t) const;
  /// The same as TOML, as an override takes it; numbers in the shortest form that gives them back.
  std::string text(double t) const;
};

}  // namespace bowstring
