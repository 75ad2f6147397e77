#include "tests/plugins/plugin_folders.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "plugins/host/sidecar.hpp"

namespace bowstring::testing {

namespace fs = std::filesystem;

std::string fixture_folder() {
  const char* root = std::getenv("BOWSTRING_BUILD_ROOT");
  if (root == nullptr) throw std::runtime_error("BOWSTRING_BUILD_ROOT is not set: run the tests with 'meson test'");
  return fs::canonical(fs::path(root) / "tests" / "plugins" / "fixtures").string();
}

std::string fixture_library(const std::string& name) { return fixture_folder() + "/bowstring_" + name + ".so"; }

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::canonical(fs::temp_directory_path()) / "bowstring-test-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder can be made");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, std::string_view content) const {
  const std::string file = path_ + "/" + name;
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

void TemporaryFolder::take_fixture(const std::string& name) const {
  fs::copy(fixture_library(name), path_);
  const fs::path sidecar = fixture_folder() + "/" + name + std::string(sidecar_suffix);
  if (fs::exists(sidecar)) fs::copy(sidecar, path_);
}

void TemporaryFolder::write_sidecar(const std::string& library, const std::string& kind, const std::string& name,
                                    const std::string& abi_tag) const {
  write(name + std::string(sidecar_suffix), R"({"file": ")" + library + R"(", "interface_version": 5, "abi_tag": ")" +
                                                abi_tag + R"(", "components": [{"kind": ")" + kind + R"(", "name": ")" +
                                                name + R"(", "description": ""}]})");
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size())) {
    text.replace(at, word.size(), by);
  }
  return text;
}

bool is_open(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  if (!maps) throw std::runtime_error("/proc/self/maps cannot be read");
  for (std::string line; std::getline(maps, line);) {
    if (line.size() >= library.size() && line.compare(line.size() - library.size(), library.size(), library) == 0) {
      return true;
    }
  }
  return false;
}

}  // namespace bowstring::testing
