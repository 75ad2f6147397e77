#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace bowstring::testing {

/// A text file in a folder of its own that goes with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    std::string folder = (std::filesystem::temp_directory_path() / "bowstring-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder could be made");
    folder_ = folder;
    std::ofstream(path(), std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string path() const { return folder_ + "/points.csv"; }

  /// `text` with every mention of the path replaced by "F".
  std::string anonymous(std::string text) const {
    for (auto at = text.find(path()); at != std::string::npos; at = text.find(path())) {
      text.replace(at, path().size(), "F");
    }
    return text;
  }

 private:
  std::string folder_;
};

}  // namespace bowstring::testing
