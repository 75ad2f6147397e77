#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bowstring {

/// "65 N mm^2" taken apart; `unit` is "" where the text is a number alone.
struct Quantity {
  double number = 0.0;
  std::string unit;
};

/// Empty where the text does not start with a number. The unit is not looked at.
std::optional<Quantity> split_quantity(std::string_view text);

enum class UnitOutcome {
  converted,
  unknown_unit,     ///< no such unit, or no multiple of one (a logarithm, an offset)
  other_dimension,  ///< a unit, but of something else
  no_database       ///< the unit needs the UDUNITS-2 database, which cannot be read
};

/// A number in the first unit is `multiplier` / `divisor` times that number in the second. Two factors, because
/// decimal units are then converted with one rounding.
struct UnitConversion {
  UnitOutcome outcome = UnitOutcome::unknown_unit;
  double multiplier = 1.0;
  double divisor = 1.0;
  double operator()(double number) const noexcept { return number * multiplier / divisor; }
};

/// Conversion between two units as UDUNITS-2 reads them, and beyond it `deg` and `Fr` (French gauge, 1/3 mm). Units
/// built from the common ones of this field are converted without loading the UDUNITS-2 database. An angle is no
/// dimension of its own (N mm/rad is N mm), but is refused where a plain number ("") is wanted.
UnitConversion convert_unit(std::string_view from, std::string_view to);

/// The same by UDUNITS-2 alone, whatever the unit. Loads the database at its first call.
UnitConversion convert_unit_by_udunits(std::string_view from, std::string_view to);

/// A unit as written, in the ASCII spelling that both ways read: "N·mm²" becomes "N*mm^2".
std::string ascii_unit(std::string_view unit);

}  // namespace bowstring
