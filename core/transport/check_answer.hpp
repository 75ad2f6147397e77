#pragma once

#include <cstddef>
#include <string>

#include "core/interfaces/transport.hpp"

namespace bowstring {

/// What is wrong with a method's answer about measures of so many places: numbers that are none, entries outside of the
/// matrix, lists of another length. "" where nothing is.
std::string flaw_of(const TransportAnswer& answer, std::size_t count_a, std::size_t count_b);

}  // namespace bowstring
