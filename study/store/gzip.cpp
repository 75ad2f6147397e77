#include "study/store/gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include "core/composition/read_file.hpp"

namespace bowstring::study {
namespace {

constexpr int level = 1;
constexpr int gzip_window = 15 + 16;  // the largest window; 16: with a gzip header, and nothing else
constexpr int memory_level = 8;
constexpr std::size_t chunk = 1U << 18U;

/// What zlib asks for input and output: pointers to bytes that it does not change, and counts of 32 bits.
class Stream {
 public:
  explicit Stream(std::string_view bytes) : rest_(bytes) {}

  z_stream& zlib() noexcept { return zlib_; }
  bool exhausted() const noexcept { return rest_.empty() && zlib_.avail_in == 0; }
  bool all_handed_over() const noexcept { return rest_.empty(); }

  void feed() {
    if (zlib_.avail_in > 0 || rest_.empty()) return;
    const std::size_t count = std::min<std::size_t>(rest_.size(), std::numeric_limits<uInt>::max());
    zlib_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    zlib_.avail_in = static_cast<uInt>(count);
    rest_.remove_prefix(count);
  }
  void make_room() {
    zlib_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
    zlib_.avail_out = static_cast<uInt>(buffer_.size());
  }
  void take(std::string& out) const { out.append(buffer_.data(), buffer_.size() - zlib_.avail_out); }

 private:
  std::string_view rest_;
  std::string buffer_ = std::string(chunk, '\0');
  z_stream zlib_{};
};

class Deflating : public Stream {
 public:
  explicit Deflating(std::string_view bytes) : Stream(bytes) {
    if (deflateInit2(&zlib(), level, Z_DEFLATED, gzip_window, memory_level, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Deflating() { deflateEnd(&zlib()); }
  Deflating(const Deflating&) = delete;
  Deflating& operator=(const Deflating&) = delete;
};

class Inflating : public Stream {
 public:
  explicit Inflating(std::string_view bytes) : Stream(bytes) {
    if (inflateInit2(&zlib(), gzip_window) != Z_OK) throw std::bad_alloc();
  }
  ~Inflating() { inflateEnd(&zlib()); }
  Inflating(const Inflating&) = delete;
  Inflating& operator=(const Inflating&) = delete;
};

}  // namespace

bool is_gzip(std::string_view bytes) noexcept { return bytes.substr(0, 2) == "\x1f\x8b"; }

std::string gzip(std::string_view bytes) {
  Deflating stream(bytes);
  std::string out;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    stream.feed();
    stream.make_room();
    state = deflate(&stream.zlib(), stream.all_handed_over() ? Z_FINISH : Z_NO_FLUSH);
    if (state == Z_STREAM_ERROR) throw std::logic_error("zlib refuses its own state");
    stream.take(out);
  }
  return out;
}

std::string gunzip(std::string_view bytes, std::string& out) {
  out.clear();
  const auto fail = [&](const std::string& why) {
    out.clear();
    return why;
  };
  if (!is_gzip(bytes)) return "it is no gzip file";
  Inflating stream(bytes);
  while (true) {
    stream.feed();
    stream.make_room();
    const int state = inflate(&stream.zlib(), Z_NO_FLUSH);
    stream.take(out);
    if (state == Z_STREAM_END) {
      if (stream.exhausted()) return "";
      if (inflateReset(&stream.zlib()) != Z_OK) throw std::logic_error("zlib refuses its own state");
    } else if (state == Z_BUF_ERROR || (state == Z_OK && stream.exhausted() && stream.zlib().avail_out > 0)) {
      return fail("it ends too early: a gzip file that was cut off");
    } else if (state == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (state != Z_OK) {
      return fail(std::string("it is damaged: ") + (stream.zlib().msg != nullptr ? stream.zlib().msg : "no gzip data"));
    }
  }
}

std::string read_gzip(const std::string& file, std::string& out) {
  out.clear();
  std::string bytes;
  const std::string why = read_file(file, bytes);
  return why.empty() ? gunzip(bytes, out) : why;
}

}  // namespace bowstring::study
