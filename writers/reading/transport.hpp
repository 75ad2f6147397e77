#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lie/so3.hpp"

namespace bowstring {

/// One of the two measures of a `bowstring.transport/1` document.
struct ComparedMeasure {
  std::string name;
  bool curve = false;  ///< its places are in order
  std::vector<Vector3> place;
  std::vector<double> weight;
};

/// Mass that goes from a place of the first measure to one of the second.
struct Carried {
  std::size_t from = 0, to = 0;
  double mass = 0.0;
};

/// What the writers take from a `bowstring.transport/1` document.
struct TransportPicture {
  std::string method, cost, unit;
  double value = 0.0;
  bool certified = false, holds = false;
  bool uniqueness_known = false, unique = false;
  ComparedMeasure a, b;
  std::vector<Carried> plan;
};

/// Empty where the text is a document of another format. Throws a StatusError with `invalid_input` where it is no JSON,
/// or not such a document.
std::optional<TransportPicture> read_transport(const char* text);

}  // namespace bowstring
