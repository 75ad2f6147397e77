#pragma once

#include <string>
#include <vector>

#include "core/check/check.hpp"
#include "core/check/claims.hpp"

namespace bowstring::checking {

struct Direction {
  std::string name;           ///< of the unknown or of the field that it moves
  std::vector<double> delta;  ///< n: of natural size
  int begin = 0, end = 0;     ///< the free unknowns that it moves
};

/// Each unknown of a small scene; of a large one random numbers, three times in each field and once in all.
std::vector<Direction> make_directions(const Assembly& assembly, unsigned seed);

/// What a quantity came to over states and directions.
struct Finding {
  struct Place {
    std::size_t state = 0, direction = 0;
    int component = 0;
  };
  double error = 0.0;  ///< largest, of what agrees; once anything is wrong, of what is wrong
  Place place;         ///< of that error
  Place kink;          ///< of the first component that is not smooth
  int compared = 0, wrong = 0, kinks = 0, unreached = 0;
  bool vanishes = true;
  std::string failure;  ///< why it could not be evaluated

  void add(const Finding& other);
};

/// Step of the differences, of the natural sizes: the middle one of those that are tried.
inline constexpr double middle_step = 4e-4;

/// What derivatives are compared with and along.
struct Sweep {
  std::vector<Quantity> quantities;
  std::vector<Direction> directions;
  std::vector<double> multipliers;
  double first_tolerance = 0.0, second_tolerance = 0.0;
};

/// One finding per quantity at one state, which is number `state` in the findings' places. Quantities that are not
/// `wanted` are left out.
std::vector<Finding> compare(Assembly& assembly, const std::vector<double>& q, std::size_t state, const Sweep& sweep,
                             const std::vector<char>& wanted);

}  // namespace bowstring::checking
