#pragma once

#include <string>

namespace bowstring {

/// Reads a whole file. Returns "", or why it cannot be read, as the second half of a sentence: "it is a folder".
std::string read_file(const std::string& file, std::string& out);

}  // namespace bowstring
