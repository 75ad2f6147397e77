#include "core/result/write_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace bowstring {

namespace {

namespace fs = std::filesystem;

Status problem(const std::string& what, const std::string& file) {
  return Status::failure(Code::invalid_input, what + " '" + file + "': " + std::strerror(errno));
}

}  // namespace

std::string obstacle(const std::string& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored) && !fs::is_regular_file(file, ignored)) return "it is no regular file";
  fs::path folder = fs::path(file).parent_path();
  if (folder.empty()) folder = ".";
  return ::access(folder.c_str(), W_OK | X_OK) == 0 ? "" : std::strerror(errno);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored) || fs::equivalent(a, b, ignored);
}

std::string behind_links(const std::string& file) {
  std::error_code ignored;
  return fs::is_symlink(file, ignored) ? fs::weakly_canonical(file, ignored).string() : file;
}

std::string temporary_name(const std::string& file) { return file + ".part-" + std::to_string(::gettid()); }

Status publish_file(const std::string& temporary, const std::string& file) {
  if (std::rename(temporary.c_str(), file.c_str()) == 0) return {};
  Status status = problem("cannot rename to", file);
  std::remove(temporary.c_str());
  return status;
}

Status write_file(const std::string& file, const std::string& content, Durability durability) {
  const std::string temporary = temporary_name(file);
  const int handle = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (handle < 0) return problem("cannot write", file);
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = ::write(handle, content.data() + written, content.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  const bool synced = durability == Durability::of_the_process || ::fsync(handle) == 0;
  const bool complete = written == content.size() && synced;
  Status status = complete ? Status{} : problem("cannot write", file);
  ::close(handle);
  if (!complete) {
    std::remove(temporary.c_str());
    return status;
  }
  return publish_file(temporary, file);
}

}  // namespace bowstring
