#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace bowstring {

/// What messages expect where a file is no result document, and how they say to mend it.
inline constexpr const char* written_by_solve = "a result document, as `bowstring solve --out` writes it";
inline constexpr const char* name_a_written_file = "name a file that was written with --out";

/// What stands there, short enough for a message.
std::string shown(const nlohmann::ordered_json& value);

/// The value under a key; null where this is no table, or has no such key.
const nlohmann::ordered_json* find_key(const nlohmann::ordered_json& table, const std::string& key);

/// The text under a key; "" where there is none.
std::string text_of(const nlohmann::ordered_json& table, const char* key);

/// Why a text is no JSON, without the library's number of the error.
std::string problem_of(const nlohmann::ordered_json::exception& error);

}  // namespace bowstring
