#include "study/store/gzip.hpp"

#include <doctest/doctest.h>

#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::study {

namespace {

/// Bytes that do not repeat soon: 3 MB, more than zlib's window and this library's buffer.
std::string many_bytes() {
  std::string out;
  unsigned state = 1;
  for (int i = 0; i < 3'000'000; ++i) {
    state = state * 1664525U + 1013904223U;
    out += static_cast<char>(state >> 24U & (i < 1'000'000 ? 0xffU : 0x03U));
  }
  return out;
}

std::string unpacked(const std::string& bytes) {
  std::string out;
  const std::string why = gunzip(bytes, out);
  REQUIRE_MESSAGE(why.empty(), why);
  return out;
}

std::string problem(const std::string& bytes) {
  std::string out = "before";
  const std::string why = gunzip(bytes, out);
  CHECK(out.empty());
  return why;
}

}  // namespace

TEST_CASE("bytes come back, whatever and however many") {
  for (const std::string& bytes : {std::string(), std::string("a"), std::string(10'000, '\0'), many_bytes()}) {
    const std::string packed = gzip(bytes);
    CHECK(is_gzip(packed));
    CHECK(unpacked(packed) == bytes);
  }
  CHECK(gzip(std::string(10'000, 'x')).size() < 200);
}

TEST_CASE("equal bytes give equal files: no time, no name") {
  const std::string packed = gzip("state");
  CHECK(gzip("state") == packed);
  REQUIRE(packed.size() > 10);
  CHECK(packed.substr(3, 5) == std::string(5, '\0'));  // RFC 1952: flags, and four bytes of time
}

TEST_CASE("a file that is cut off is told, wherever") {
  const std::string packed = gzip(many_bytes().substr(0, 5000));
  for (const std::size_t length :
       {std::size_t{2}, std::size_t{9}, std::size_t{10}, packed.size() / 2, packed.size() - 8, packed.size() - 1}) {
    CHECK_MESSAGE(problem(packed.substr(0, length)) == "it ends too early: a gzip file that was cut off", length);
  }
}

TEST_CASE("a damaged file is told") {
  std::string packed = gzip(many_bytes().substr(0, 5000));
  std::string sum = packed;
  sum[sum.size() - 6] = static_cast<char>(sum[sum.size() - 6] + 1);
  CHECK(problem(sum) == "it is damaged: incorrect data check");
  std::string length = packed;
  length[length.size() - 1] = static_cast<char>(length[length.size() - 1] + 1);
  CHECK(problem(length) == "it is damaged: incorrect length check");
  CHECK(problem(packed + "more") == "it is damaged: incorrect header check");
  CHECK(problem("{\"format\": 1}") == "it is no gzip file");
  CHECK(problem("") == "it is no gzip file");
}

TEST_CASE("several files one after the other are one, as gzip reads them") {
  CHECK(unpacked(gzip("one ") + gzip("") + gzip("two")) == "one two");
}

TEST_CASE("a file, or why not") {
  const testing::TemporaryFolder folder;
  std::string out = "before";
  CHECK(read_gzip(folder.path() + "/none.gz", out) == "No such file or directory");
  CHECK(out.empty());
  CHECK(read_gzip(folder.path(), out) == "it is a folder");
  const std::string file = folder.write("state.gz", gzip("state"));
  CHECK(read_gzip(file, out) == "");
  CHECK(out == "state");
}

}  // namespace bowstring::study
