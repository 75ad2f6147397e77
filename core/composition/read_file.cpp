#include "core/composition/read_file.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace bowstring {
namespace {

constexpr std::size_t piece_size = 1U << 16U;

}  // namespace

std::string read_file(const std::string& file, std::string& out) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder";
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return errno != 0 ? std::strerror(errno) : "it cannot be opened";
  out.clear();
  std::string piece(piece_size, '\0');
  do {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    out.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  return stream.bad() ? "reading it failed" : "";
}

}  // namespace bowstring
