#include "study/store/claim.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace bowstring::study {
namespace {

/// Byte 0 is the folder's; 60 bits of a hash name a run's.
constexpr long long folder_byte = 0;

long long byte_of(const std::string& hash) { return 1 + std::stoll(hash.substr(0, 15), nullptr, 16); }

struct flock byte_range(long long byte, short kind) {
  struct flock range = {};
  range.l_type = kind;
  range.l_whence = SEEK_SET;
  range.l_start = byte;
  range.l_len = 1;
  return range;
}

}  // namespace

Claims::~Claims() {
  if (file_ >= 0) ::close(file_);
}

Status Claims::open(const std::string& file) {
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) return Status::failure(Code::invalid_input, "cannot write '" + file + "': " + std::strerror(errno));
  // A file system without locks refuses the question already; to wait for one there would never end.
  struct flock range = byte_range(folder_byte, F_WRLCK);
  if (::fcntl(file_, F_OFD_GETLK, &range) == 0) return {};
  return Status::failure(Code::invalid_input, "cannot lock '" + file + "': " + std::strerror(errno) +
                                                  "; expected a file system with locks; name another folder");
}

bool Claims::lock(long long byte, short kind, bool wait) {
  struct flock range = byte_range(byte, kind);
  int outcome = 0;
  do {
    outcome = ::fcntl(file_, wait ? F_OFD_SETLKW : F_OFD_SETLK, &range);
  } while (outcome < 0 && errno == EINTR);
  return outcome == 0;
}

bool Claims::take(const std::string& hash) { return lock(byte_of(hash), F_WRLCK, false); }
void Claims::leave(const std::string& hash) { lock(byte_of(hash), F_UNLCK, false); }
void Claims::take_folder() { lock(folder_byte, F_WRLCK, true); }
void Claims::leave_folder() { lock(folder_byte, F_UNLCK, false); }

}  // namespace bowstring::study
