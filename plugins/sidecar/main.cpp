#include <cstdio>
#include <string>
#include <vector>

#include "core/interfaces/component.hpp"
#include "plugins/host/elf.hpp"
#include "plugins/host/library.hpp"
#include "plugins/host/sidecar.hpp"

namespace bowstring {
namespace {

std::string listed(const std::vector<std::string>& symbols) {
  std::string out;
  for (const std::string& symbol : symbols) out += "\n  " + symbol;
  return out;
}

/// One exported symbol, so that two plugins from the same sources cannot bind to each other's functions and constants.
Status check_exports(const std::string& library) {
  std::string bytes;
  ElfContents contents;
  if (Status status = read_bytes(library, bytes); !status.ok()) return status;
  if (Status status = read_elf(bytes, contents); !status.ok()) return status;
  if (!contents.unique.empty()) {
    return Status::failure(Code::failed,
                           "it has GNU_UNIQUE symbols, which all plugins of a process share; compile "
                           "with -fno-gnu-unique and link with the SDK's plugin.map:" +
                               listed(contents.unique));
  }
  if (contents.exported != std::vector<std::string>{plugin_symbol}) {
    return Status::failure(Code::failed,
                           "a plugin exports the one symbol bowstring_plugin; compile with "
                           "-fvisibility=hidden and link with the SDK's plugin.map; it exports " +
                               (contents.exported.empty() ? "none" : listed(contents.exported)));
  }
  return {};
}

Status write(const std::string& library, const std::string& output) {
  if (Status status = check_library_file(library); !status.ok()) return status;
  if (Status status = check_exports(library); !status.ok()) {
    return Status::failure(status.code, "plugin library '" + library + "' is refused: " + status.text);
  }
  const PluginDescriptor* plugin = nullptr;
  if (Status status = open_library(library, &plugin); !status.ok()) return status;
  return write_sidecar({library, plugin->interface_version, plugin->abi_tag, offered_components(*plugin)}, output);
}

}  // namespace
}  // namespace bowstring

/// Checks a built plugin library and writes its sidecar.
int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: bowstring-sidecar LIBRARY OUTPUT.bowstring.json\n", stderr);
    return 2;
  }
  const bowstring::Status status = bowstring::write(arguments[1], arguments[2]);
  if (status.ok()) return 0;
  std::fprintf(stderr, "bowstring-sidecar: %s\n", status.text.c_str());
  return 3;
}
