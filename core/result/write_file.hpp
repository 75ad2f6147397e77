#pragma once

#include <string>

#include "core/interfaces/status.hpp"

namespace bowstring {

/// Why a new file cannot be put there; "" where it can. Devices and pipes are never replaced.
std::string obstacle(const std::string& file);

/// One file by two names, through links or not.
bool same_file(const std::string& a, const std::string& b);

/// Where a symbolic link leads, so that the link stays.
std::string behind_links(const std::string& file);

/// A name beside `file` that no other thread of any process uses, for content that is renamed when it is whole.
std::string temporary_name(const std::string& file);

/// What a written file is safe from: the end of any process, or of the machine as well, which takes milliseconds.
enum class Durability : int { of_the_process, of_the_machine };

/// Writes `content` to `file`, whole or not at all: to a temporary name in the same folder, synced, then renamed.
Status write_file(const std::string& file, const std::string& content,
                  Durability durability = Durability::of_the_machine);

/// Renames a finished temporary file to its name.
Status publish_file(const std::string& temporary, const std::string& file);

}  // namespace bowstring
