#pragma once

#include <string>
#include <string_view>

namespace bowstring::study {

/// Whether bytes begin as a gzip file does (RFC 1952).
bool is_gzip(std::string_view bytes) noexcept;

/// The bytes as a gzip file at level 1, without a name or a time: equal bytes give equal files.
std::string gzip(std::string_view bytes);

/// What gzip files hold, one after the other. Returns "", or what is wrong with them, as the second half of a sentence:
/// "it ends too early: …"; then `out` is empty.
std::string gunzip(std::string_view bytes, std::string& out);

/// What a gzip file holds. Returns "", or why it cannot be read, likewise.
std::string read_gzip(const std::string& file, std::string& out);

}  // namespace bowstring::study
