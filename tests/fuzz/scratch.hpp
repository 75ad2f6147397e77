#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace bowstring::fuzz {

/// A folder of the process's own that is its working directory, so that what an input names by a relative path is not
/// found outside of it. The input's text is written to a file there.
const std::string& scratch_file(const std::uint8_t* data, std::size_t size);

/// Writes another file into that folder.
void write_scratch(const char* name, const char* text);

/// Whether a text is UTF-8. What an input in UTF-8 leads to is printed, so that it has to be, too: no letter may be
/// cut.
bool is_utf8(const std::string& text);

/// Says what is wrong and aborts, which is what a fuzzer and the driver take for a finding.
[[noreturn]] void finding(const std::string& text);
inline void require(bool holds, const char* text) {
  if (!holds) finding(text);
}

}  // namespace bowstring::fuzz

/// One function per target, as libFuzzer calls it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
