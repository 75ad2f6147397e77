#include "plugins/host/elf.hpp"

#include <doctest/doctest.h>

#include "plugins/host/library.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

using testing::fixture_library;

namespace {
std::string bytes_of(const std::string& library) {
  std::string bytes;
  REQUIRE(read_bytes(library, bytes).ok());
  REQUIRE(bytes.size() > 1000);
  return bytes;
}
}  // namespace

TEST_CASE("a plugin's file tells its ABI tag and exports one symbol") {
  ElfContents contents;
  REQUIRE(read_elf(bytes_of(fixture_library("every-kind")), contents).ok());
  CHECK(contents.abi_tag == host_abi_tag());
  CHECK(contents.exported == std::vector<std::string>{"bowstring_plugin"});
  CHECK(contents.unique.empty());
}

TEST_CASE("what is no shared library is refused in words") {
  ElfContents contents;
  CHECK(read_elf("", contents).text == "it is empty");
  CHECK(read_elf("#!/bin/sh\n", contents).text == "it is not an ELF file");
  CHECK(read_elf("\x7f"
                 "ELF",
                 contents)
            .text == "its ELF structure is damaged: it ends within its header");
  std::string small = bytes_of(fixture_library("every-kind"));
  small[4] = 1;  // EI_CLASS: 32 bits
  CHECK(read_elf(small, contents).text == "it is an ELF file for another kind of machine, not 64-bit little-endian");
  std::string program = bytes_of(fixture_library("every-kind"));
  program[16] = 2;  // e_type: executable
  CHECK(read_elf(program, contents).text == "it is an ELF file but no shared library");
}

TEST_CASE("a truncated library is refused at every length") {
  const std::string bytes = bytes_of(fixture_library("no-descriptor"));
  ElfContents contents;
  REQUIRE(read_elf(bytes, contents).ok());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // Its own allocation, so that a sanitizer sees a read past the end.
    const std::string part(bytes, 0, size);
    CHECK_MESSAGE(!read_elf(part, contents).ok(), size);
  }
}

TEST_CASE("a library with any byte of its headers damaged is read within its bounds") {
  const std::string bytes = bytes_of(fixture_library("no-descriptor"));
  std::uint64_t section_headers = 0;
  for (std::size_t i = 8; i-- > 0;)
    section_headers = section_headers << 8 | static_cast<unsigned char>(bytes[0x28 + i]);
  REQUIRE(section_headers < bytes.size());
  int refused = 0;
  const auto damage = [&](std::size_t at) {
    for (const char value : {'\0', '\x7f', '\xff'}) {
      std::string damaged = bytes;
      damaged[at] = value;
      ElfContents contents;
      if (!read_elf(damaged, contents).ok()) ++refused;
    }
  };
  for (std::size_t at = 0; at < 64; ++at) damage(at);
  for (std::size_t at = section_headers; at < bytes.size(); ++at) damage(at);
  CHECK(refused > 50);
}

TEST_CASE("a file that cannot be read is told apart") {
  std::string bytes;
  CHECK(read_bytes("/nonexistent.so", bytes).text == "it cannot be read: No such file or directory");
  CHECK(read_bytes("/tmp", bytes).text == "it cannot be read: it is a folder");
}

}  // namespace bowstring
