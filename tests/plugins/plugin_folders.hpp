#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace bowstring::testing {

/// Where the build puts the plugins and libraries of tests/plugins/fixtures.
std::string fixture_folder();
/// fixture_folder()/bowstring_NAME.so
std::string fixture_library(const std::string& name);

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Writes a file into it and returns its path.
  std::string write(const std::string& name, std::string_view content) const;
  /// Copies a fixture's library, and its sidecar where it has one.
  void take_fixture(const std::string& name) const;
  /// Writes the sidecar of a library in this folder that offers one component.
  void write_sidecar(const std::string& library, const std::string& kind, const std::string& name,
                     const std::string& abi_tag) const;

 private:
  std::string path_;
};

/// `text` with every occurrence of `word` replaced: paths of the machine become short names.
std::string replaced(std::string text, const std::string& word, const std::string& by);

/// Whether this process has the file mapped, by its own list of mappings.
bool is_open(const std::string& library);

}  // namespace bowstring::testing
