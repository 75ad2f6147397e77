#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "tests/composition/fake_registry.hpp"

namespace bowstring::test {

/// A fresh folder that is the working directory as long as this lives, so that messages name files as a user
/// would give them.
class Workbench {
 public:
  Workbench();
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /// Writes a file, with its folders, relative to the folder.
  void write(const std::string& file, const std::string& text) const;

  CompositionOutcome load(const std::string& file, const std::vector<Override>& overrides = {});
  /// Writes the text to scene.toml and loads it.
  CompositionOutcome load_text(const std::string& text, const std::vector<Override>& overrides = {});
  /// The same, for a composition that has to be right.
  Composition loaded(const std::string& text, const std::vector<Override>& overrides = {});
  /// The same, for what is wrong with it.
  std::vector<std::string> errors(const std::string& text, const std::vector<Override>& overrides = {});

  FakeRegistry registry;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_, previous_;
};

std::vector<std::string> texts(const std::vector<InputError>& errors);

/// The composition of the format's documentation.
extern const char* const planar_iliac;

/// A small right composition: vessel 'v', wire 'w', and energies on both.
extern const char* const small_scene;

}  // namespace bowstring::test

/// Shows lists of messages one below the other where a check fails.
template <>
struct doctest::StringMaker<std::vector<std::string>> {
  static String convert(const std::vector<std::string>& lines) {
    std::string text = "{";
    for (const std::string& line : lines) text += "\n  " + line;
    return (text + "\n}").c_str();
  }
};
