#pragma once

#include <string>
#include <vector>

#include "tests/losses/transport/opened_transport.hpp"

namespace bowstring::testing {

/// 'unbalanced' of a penalty, with epsilon where it is above zero.
inline TransportComparison unbalanced(const std::string& penalty, double weight, double epsilon = 0.0) {
  Settings settings = {{"penalty", penalty}, {"marginal-weight", text(weight)}};
  if (epsilon > 0.0) settings.push_back({"epsilon", text(epsilon)});
  return open_transport("unbalanced", settings);
}

inline double figure(const TransportAnswer& answer, const std::string& name) {
  for (const auto& [key, value] : answer.figures) {
    if (key == name) return value;
  }
  return -1.0;
}

}  // namespace bowstring::testing
