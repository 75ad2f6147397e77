#pragma once

#include <nlohmann/json.hpp>

#include "core/transport/transport_comparison.hpp"

namespace bowstring {

/// The keys that a comparison has wherever a document holds one, from `value` to `figures`. `mass` as in
/// `certificate_holds`.
nlohmann::ordered_json transport_answer_json(const TransportResult& result, double mass);

/// The rows of a list of `per_row` numbers each; null of an empty one.
nlohmann::ordered_json rows_or_null(const std::vector<double>& numbers, std::size_t per_row);

/// A list of numbers; null of an empty one.
nlohmann::ordered_json numbers_or_null(const std::vector<double>& numbers);

/// A finite number, or null.
nlohmann::ordered_json finite_or_null(double number);

}  // namespace bowstring
