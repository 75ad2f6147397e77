#pragma once

#include <string>

#include "core/interfaces/status.hpp"

namespace bowstring {

/// A name beside `file` that nobody else uses, for content that is renamed when it is whole.
std::string temporary_name(const std::string& file);

/// Writes `content` to `file`, whole or not at all: to a temporary name in the same folder, synced, then renamed.
Status write_file(const std::string& file, const std::string& content);

/// Renames a finished temporary file to its name.
Status publish_file(const std::string& temporary, const std::string& file);

}  // namespace bowstring
