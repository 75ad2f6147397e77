#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/interfaces/status.hpp"

namespace bowstring {

/// What can be known of a shared library from its file, before opening it runs its code.
struct ElfContents {
  std::string abi_tag;                ///< of section `.bowstring.abi`; "" where there is none
  std::vector<std::string> exported;  ///< defined dynamic symbols that other libraries can bind to, sorted
  std::vector<std::string> unique;  ///< those of them that are GNU_UNIQUE: one for the whole process, RTLD_LOCAL or not
};

/// Reads the section headers of a 64-bit little-endian ELF file held in memory. Symbols that every linker makes
/// (_init, _edata, …) are left out. `failed` with what is wrong where `bytes` is no shared library, or is damaged.
/// System V ABI, ch. 4 and 5.
Status read_elf(std::string_view bytes, ElfContents& out);

/// A whole file; `failed` where it cannot be read.
Status read_bytes(const std::string& file, std::string& out);

}  // namespace bowstring
