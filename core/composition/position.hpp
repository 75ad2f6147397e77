#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace bowstring {

/// A text that values come from: a file, or one override of the command line.
struct Source {
  std::string name;                 ///< as the user gave it: "scenes/iliac.toml", "--set solver.tolerance=1"
  std::filesystem::path directory;  ///< absolute: what paths written in the text are relative to
  int order = 0;                    ///< errors are listed by it: the user's file, its bases, the command line
};

/// Where a value stands. Without a source: in no text, a default.
struct Position {
  std::shared_ptr<const Source> source;
  int line = 0, column = 0;  ///< from 1; line 0: the source as a whole

  /// "file:line:column", or the source's name, or "".
  std::string text() const;
  bool before(const Position& other) const noexcept;
};

}  // namespace bowstring
