#pragma once

#include <string>

namespace bowstring {

/// RFC 4648, section 4, padded, without line breaks.
std::string base64(const std::string& bytes);

}  // namespace bowstring
