// Preloaded before the command: after so many writes into files of one folder the disk is full, or whatever
// BOWSTRING_TEST_WRITE_ERROR says. The count goes on over forks.

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

std::string text(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

struct Settings {
  std::string folder = text("BOWSTRING_TEST_WRITE_FOLDER");
  long allowed = std::atol(text("BOWSTRING_TEST_WRITES").c_str());
  int error = text("BOWSTRING_TEST_WRITE_ERROR") == "ENOSPC" ? ENOSPC : EIO;
  std::atomic<long>* count =
      new (::mmap(nullptr, sizeof(std::atomic<long>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
          std::atomic<long>(0);
};

bool is_watched(int file, const std::string& folder) {
  char place[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t length = ::readlink(link.c_str(), place, sizeof place - 1);
  return length > 0 && std::string(place, static_cast<std::size_t>(length)).rfind(folder, 0) == 0;
}

}  // namespace

extern "C" ssize_t write(int file, const void* bytes, std::size_t count) {
  static const auto real = reinterpret_cast<ssize_t (*)(int, const void*, std::size_t)>(::dlsym(RTLD_NEXT, "write"));
  static const Settings settings;
  if (file > 2 && is_watched(file, settings.folder) && (*settings.count)++ >= settings.allowed) {
    // A full disk takes what still fits.
    if (count > 1) (void)!real(file, bytes, count / 2);
    errno = settings.error;
    return -1;
  }
  return real(file, bytes, count);
}
