#pragma once

#include <string>
#include <vector>

namespace bowstring::testing {

struct CommandResult {
  int exit_code = -1;  ///< 128 + signal where a signal ended it
  std::string out;     ///< stdout
  std::string err;     ///< stderr
};

/// Runs this build's `bowstring` in a folder, with empty stdin and both outputs in files, so that it sees no terminal.
CommandResult bowstring_command(const std::string& folder, const std::vector<std::string>& arguments);

/// The repository's root.
std::string source_root();

std::string read_text(const std::string& file);

/// The text of a shipped composition.
std::string shipped_scene(const std::string& name);

/// The names of a folder's entries, sorted.
std::vector<std::string> entries(const std::string& folder);

/// `text` with the only occurrence of `word` replaced; throws where it does not stand there exactly once.
std::string edited(std::string text, const std::string& word, const std::string& by);

/// "FILE:LINE:COLUMN" of the only occurrence of `word` in the text, both from 1; `skip` characters into the word.
std::string position(const std::string& file, const std::string& text, const std::string& word, std::size_t skip = 0);

/// Whether `text` contains `part`.
bool contains(const std::string& text, const std::string& part);

}  // namespace bowstring::testing
