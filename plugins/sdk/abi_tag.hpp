#pragma once

#include <cstddef>
#include <string>  // defines the standard library's own macros

#include "core/interfaces/component.hpp"

namespace bowstring {

/// What two binaries must share to exchange the objects of core/interfaces: NUL-terminated text such as
/// "bowstring-2/gxx-abi-1017/libstdc++-cxx11/double".
struct AbiTag {
  char text[64];
};

namespace abi_detail {

struct TagBuilder {
  AbiTag tag{};
  std::size_t size = 0;

  constexpr TagBuilder& add(const char* text) {
    for (; *text != '\0'; ++text) tag.text[size++] = *text;
    return *this;
  }
  constexpr TagBuilder& add(unsigned long number) {
    if (number >= 10) add(number / 10);
    tag.text[size++] = static_cast<char>('0' + number % 10);
    return *this;
  }
};

/// The layout of the standard library's strings and containers.
#if defined(_GLIBCXX_DEBUG)
inline constexpr const char* standard_library = "libstdc++-debug";
#elif defined(__GLIBCXX__) && _GLIBCXX_USE_CXX11_ABI
inline constexpr const char* standard_library = "libstdc++-cxx11";
#elif defined(__GLIBCXX__)
inline constexpr const char* standard_library = "libstdc++-cxx98";
#elif defined(_LIBCPP_VERSION)
inline constexpr const char* standard_library = "libc++";
inline constexpr unsigned long standard_library_version = _LIBCPP_ABI_VERSION;
#else
#error "bowstring plugins need libstdc++ or libc++"
#endif

}  // namespace abi_detail

/// The tag of this translation unit. One that outgrew its array would not compile.
constexpr AbiTag make_abi_tag() {
  abi_detail::TagBuilder builder;
  builder.add("bowstring-").add(interface_version);
  builder.add("/gxx-abi-").add(__GXX_ABI_VERSION);
  builder.add("/").add(abi_detail::standard_library);
#if defined(_LIBCPP_VERSION)
  builder.add("-").add(abi_detail::standard_library_version);
#endif
  builder.add("/double");
  return builder.tag;
}

/// Section of a plugin's ELF file that holds the tag, so that it is known before the library is opened.
inline constexpr const char* abi_section = ".bowstring.abi";

}  // namespace bowstring
