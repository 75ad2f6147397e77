#pragma once

#include <optional>
#include <string_view>

namespace bowstring {

/// A product of powers of mm, N and rad, `multiplier` / `divisor` times.
struct CommonUnit {
  double multiplier = 1.0;
  double divisor = 1.0;
  int length = 0, force = 0, angle = 0;
};

/// Reads a unit (ASCII spelling) that is built from mm, cm, m, um, in, Fr, N, mN, kN, Pa, kPa, MPa, GPa, rad and deg
/// by products, quotients and whole powers, with the grammar of UDUNITS-2: "N mm^2", "N*mm2", "1/mm". A quotient
/// divides by the next factor only. Empty for everything else, which is not yet to say that it is wrong.
std::optional<CommonUnit> read_common_unit(std::string_view unit);

}  // namespace bowstring
