#include "tests/fuzz/scratch.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bowstring::fuzz {

namespace {

/// Goes with the process, unless that ends by a finding.
struct Folder {
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "bowstring-fuzz-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) finding("no temporary folder can be made");
    path = pattern;
    std::filesystem::current_path(path);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::current_path("/", ignored);
    std::filesystem::remove_all(path, ignored);
  }
  std::string path;
};

const Folder& folder() {
  static const Folder made;
  return made;
}

}  // namespace

const std::string& scratch_file(const std::uint8_t* data, std::size_t size) {
  static const std::string file = folder().path + "/input";
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

void write_scratch(const char* name, const char* text) { std::ofstream(folder().path + "/" + name) << text; }

bool is_utf8(const std::string& text) {
  int follow = 0;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool continues = (byte & 0xc0U) == 0x80U;
    if (continues != (follow > 0)) return false;
    if (continues) {
      --follow;
    } else {
      follow = byte < 0x80U              ? 0
               : (byte & 0xe0U) == 0xc0U ? 1
               : (byte & 0xf0U) == 0xe0U ? 2
               : (byte & 0xf8U) == 0xf0U ? 3
                                         : -1;
      if (follow < 0) return false;
    }
  }
  return follow == 0;
}

void finding(const std::string& text) {
  std::fprintf(stderr, "finding: %s\n", text.c_str());
  std::abort();
}

}  // namespace bowstring::fuzz
