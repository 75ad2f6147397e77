#include "core/composition/read_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace bowstring {

std::string read_file(const std::string& file, std::string& out) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder";
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return errno != 0 ? std::strerror(errno) : "it cannot be opened";
  out.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  return stream.bad() ? "reading it failed" : "";
}

}  // namespace bowstring
