#include "plugins/host/elf.hpp"

#include <elf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "core/composition/read_file.hpp"
#include "plugins/sdk/abi_tag.hpp"

namespace bowstring {

namespace {

Status damaged(const char* what) {
  return Status::failure(Code::failed, std::string("its ELF structure is damaged: ") + what);
}

/// Reads within bounds: whatever offsets a file claims, nothing outside it is touched.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  std::optional<std::string_view> slice(std::uint64_t offset, std::uint64_t size) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) return std::nullopt;
    return bytes_.substr(offset, size);
  }

  template <class Record>
  std::optional<Record> record(std::uint64_t offset) const {
    const auto raw = slice(offset, sizeof(Record));
    if (!raw) return std::nullopt;
    Record out;
    std::memcpy(&out, raw->data(), sizeof(Record));
    return out;
  }

  /// NUL-terminated text at `offset`; nothing where it runs over the end.
  std::optional<std::string_view> text(std::uint64_t offset) const {
    if (offset >= bytes_.size()) return std::nullopt;
    const std::size_t end = bytes_.find('\0', offset);
    if (end == std::string_view::npos) return std::nullopt;
    return bytes_.substr(offset, end - offset);
  }

 private:
  std::string_view bytes_;
};

bool made_by_linker(std::string_view symbol) {
  constexpr std::array<std::string_view, 5> names = {"_init", "_fini", "_edata", "_end", "__bss_start"};
  return std::find(names.begin(), names.end(), symbol) != names.end();
}

bool visible_outside(const Elf64_Sym& symbol) {
  const int binding = ELF64_ST_BIND(symbol.st_info);
  const int visibility = ELF64_ST_VISIBILITY(symbol.st_other);
  return symbol.st_shndx != SHN_UNDEF && binding != STB_LOCAL &&
         (visibility == STV_DEFAULT || visibility == STV_PROTECTED);
}

Status check_header(std::string_view bytes, const std::optional<Elf64_Ehdr>& header) {
  if (bytes.substr(0, SELFMAG) != std::string_view(ELFMAG, SELFMAG)) {
    return Status::failure(Code::failed, bytes.empty() ? "it is empty" : "it is not an ELF file");
  }
  if (!header) return damaged("it ends within its header");
  if (header->e_ident[EI_CLASS] != ELFCLASS64 || header->e_ident[EI_DATA] != ELFDATA2LSB) {
    return Status::failure(Code::failed, "it is an ELF file for another kind of machine, not 64-bit little-endian");
  }
  if (header->e_type != ET_DYN) return Status::failure(Code::failed, "it is an ELF file but no shared library");
  if (header->e_shnum == 0 || header->e_shentsize != sizeof(Elf64_Shdr)) return damaged("it has no section headers");
  return {};
}

Status read_sections(const Bytes& bytes, const Elf64_Ehdr& header, std::vector<Elf64_Shdr>& out) {
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const std::optional<Elf64_Shdr> section = bytes.record<Elf64_Shdr>(header.e_shoff + i * sizeof(Elf64_Shdr));
    if (!section) return damaged("its section headers lie outside the file");
    out.push_back(*section);
  }
  if (header.e_shstrndx >= out.size()) return damaged("its section names are missing");
  return {};
}

Status read_abi_tag(const Bytes& bytes, const Elf64_Shdr& section, std::string& out) {
  const auto content = bytes.slice(section.sh_offset, section.sh_size);
  if (!content) return damaged("section .bowstring.abi lies outside the file");
  const auto text = Bytes(*content).text(0);
  if (!text || text->empty()) return damaged("section .bowstring.abi holds no text");
  out = *text;
  return {};
}

Status read_symbols(const Bytes& bytes, const std::vector<Elf64_Shdr>& sections, const Elf64_Shdr& table,
                    ElfContents& out) {
  if (table.sh_link >= sections.size()) return damaged("its dynamic symbols have no names");
  const Elf64_Shdr& strings = sections[table.sh_link];
  const auto names = bytes.slice(strings.sh_offset, strings.sh_size);
  const auto symbols = bytes.slice(table.sh_offset, table.sh_size);
  if (!names || !symbols) return damaged("its dynamic symbols lie outside the file");
  for (std::uint64_t at = 0; at + sizeof(Elf64_Sym) <= symbols->size(); at += sizeof(Elf64_Sym)) {
    const Elf64_Sym symbol = *Bytes(*symbols).record<Elf64_Sym>(at);
    if (!visible_outside(symbol)) continue;
    const auto name = Bytes(*names).text(symbol.st_name);
    if (!name) return damaged("a dynamic symbol's name lies outside the file");
    if (made_by_linker(*name)) continue;
    out.exported.emplace_back(*name);
    if (ELF64_ST_BIND(symbol.st_info) == STB_GNU_UNIQUE) out.unique.emplace_back(*name);
  }
  std::sort(out.exported.begin(), out.exported.end());
  std::sort(out.unique.begin(), out.unique.end());
  return {};
}

}  // namespace

Status read_elf(std::string_view file, ElfContents& out) {
  out = {};
  const Bytes bytes(file);
  const std::optional<Elf64_Ehdr> header = bytes.record<Elf64_Ehdr>(0);
  if (Status status = check_header(file, header); !status.ok()) return status;
  std::vector<Elf64_Shdr> sections;
  if (Status status = read_sections(bytes, *header, sections); !status.ok()) return status;

  const Elf64_Shdr& names = sections[header->e_shstrndx];
  const auto section_names = bytes.slice(names.sh_offset, names.sh_size);
  if (!section_names) return damaged("its section names lie outside the file");
  for (const Elf64_Shdr& section : sections) {
    Status status;
    if (section.sh_type == SHT_DYNSYM) status = read_symbols(bytes, sections, section, out);
    if (Bytes(*section_names).text(section.sh_name) == std::string_view(abi_section)) {
      status = read_abi_tag(bytes, section, out.abi_tag);
    }
    if (!status.ok()) return status;
  }
  return {};
}

Status read_bytes(const std::string& file, std::string& out) {
  const std::string why = read_file(file, out);
  return why.empty() ? Status{} : Status::failure(Code::failed, "it cannot be read: " + why);
}

}  // namespace bowstring
