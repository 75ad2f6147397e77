#pragma once

#include <string>
#include <string_view>

namespace bowstring {

/// SHA-256 of `bytes` (FIPS 180-4, section 6.2) as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace bowstring
