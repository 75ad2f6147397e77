#include "plugins/host/library.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include <boost/dll/shared_library.hpp>

#include "plugins/host/elf.hpp"
#include "plugins/sdk/abi_tag.hpp"

namespace bowstring {

namespace {

constexpr const char* rebuild_advice = "rebuild it against this bowstring";

Status failure(const std::string& library, const std::string& found, const std::string& mend) {
  return Status::failure(Code::failed, "plugin library '" + library + "' " + found + "; " + mend);
}

Status not_a_plugin(const std::string& library, const std::string& found) {
  return Status::failure(Code::failed, "'" + library + "' is not a plugin library: " + found +
                                           "; expected a shared library whose source ends with BOWSTRING_PLUGIN");
}

/// Lower-case words joined by hyphens: "wire-bending", "rkmk4".
bool well_formed(std::string_view name) {
  if (name.empty() || name.front() == '-' || name.back() == '-') return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; });
}

/// What is wrong with one component, or "".
std::string fault(const ComponentDescriptor& component) {
  const int kind = static_cast<int>(component.kind);
  if (kind < 0 || kind >= kind_count) return "of kind " + std::to_string(kind) + ", which does not exist";
  if (component.name == nullptr || !well_formed(component.name)) {
    return "whose name '" + std::string(component.name != nullptr ? component.name : "") +
           "' is not lower-case words joined by hyphens";
  }
  if (component.description == nullptr) return "'" + std::string(component.name) + "' without a description";
  if (component.create == nullptr || component.destroy == nullptr) {
    return "'" + std::string(component.name) + "' without a factory";
  }
  if (component.parameter_count < 0 || (component.parameter_count > 0 && component.parameters == nullptr)) {
    return "'" + std::string(component.name) + "' whose parameter table is missing";
  }
  return "";
}

Status check_descriptor(const std::string& library, const PluginDescriptor& plugin) {
  if (plugin.magic != plugin_magic || plugin.size != sizeof(PluginDescriptor)) {
    return failure(library,
                   "exports a '" + std::string(plugin_symbol) + "' that is no plugin descriptor of this bowstring",
                   rebuild_advice);
  }
  if (plugin.interface_version != interface_version) {
    return failure(library,
                   "has interface version " + std::to_string(plugin.interface_version) + ", this bowstring " +
                       std::to_string(interface_version),
                   rebuild_advice);
  }
  if (plugin.abi_tag == nullptr) return failure(library, "has a descriptor without ABI tag", rebuild_advice);
  if (Status status = check_abi(library, plugin.abi_tag, "its descriptor"); !status.ok()) return status;
  if (plugin.component_count <= 0 || plugin.components == nullptr) {
    return failure(library, "offers no component", "name at least one in BOWSTRING_PLUGIN");
  }
  std::vector<OfferedComponent> seen;
  for (int i = 0; i < plugin.component_count; ++i) {
    const ComponentDescriptor& component = plugin.components[i];
    if (const std::string text = fault(component); !text.empty()) {
      return failure(library, "offers a component " + text, "mend its line in BOWSTRING_PLUGIN");
    }
    for (const OfferedComponent& other : seen) {
      if (other.kind != component.kind || other.name != component.name) continue;
      return failure(library, "offers " + std::string(kind_name(component.kind)) + " '" + component.name + "' twice",
                     "rename one of them in BOWSTRING_PLUGIN");
    }
    seen.push_back({component.kind, component.name, component.description});
  }
  return {};
}

/// The dynamic loader's own words, without the file name that starts them: "undefined symbol: _Z3foov".
std::string loader_text(const std::string& library) {
  const char* raw = ::dlerror();
  std::string text = raw != nullptr ? raw : "the dynamic loader gives no reason";
  if (text.compare(0, library.size() + 2, library + ": ") == 0) text.erase(0, library.size() + 2);
  return text;
}

}  // namespace

std::string host_abi_tag() { return make_abi_tag().text; }

Status check_abi(const std::string& library, const std::string& tag, const std::string& where) {
  const std::string host = host_abi_tag();
  if (tag == host) return {};
  return failure(library,
                 "was built for another ABI: " + where + " says '" + tag + "', this bowstring is '" + host + "'",
                 "rebuild it against this bowstring with the compiler and standard library of that tag, or take the "
                 "bowstring that it was built for");
}

Status check_library_file(const std::string& library) {
  std::string bytes;
  ElfContents contents;
  Status status = read_bytes(library, bytes);
  if (status.ok()) status = read_elf(bytes, contents);
  if (!status.ok()) return not_a_plugin(library, status.text);
  if (contents.abi_tag.empty()) return not_a_plugin(library, "it has no section '" + std::string(abi_section) + "'");
  return check_abi(library, contents.abi_tag, "section " + std::string(abi_section));
}

namespace {

/// Objects and functions of a library outlive every owner of a handle, and this process's static destructors: it is
/// never closed.
const boost::dll::shared_library& keep_open(std::unique_ptr<boost::dll::shared_library> handle) {
  static std::mutex lock;
  static auto& handles = *new std::vector<std::unique_ptr<boost::dll::shared_library>>;
  const std::lock_guard<std::mutex> guard(lock);
  handles.push_back(std::move(handle));
  return *handles.back();
}

}  // namespace

Status open_library(const std::string& library, const PluginDescriptor** out) {
  namespace dll = boost::dll;
  auto handle = std::make_unique<dll::shared_library>();
  std::error_code error;
  ::dlerror();  // forgets what an earlier failure of somebody else left
  handle->load(library, error, dll::load_mode::rtld_now | dll::load_mode::rtld_local);
  if (error) {
    return failure(library, "cannot be opened: " + loader_text(library),
                   "rebuild it, and install the libraries that it needs (ldd names them)");
  }
  const dll::shared_library& open = keep_open(std::move(handle));
  if (!open.has(plugin_symbol)) {
    return not_a_plugin(library, "it exports no symbol '" + std::string(plugin_symbol) + "'");
  }
  const auto& plugin = open.get<const PluginDescriptor>(plugin_symbol);
  if (Status status = check_descriptor(library, plugin); !status.ok()) return status;
  *out = &plugin;
  return {};
}

std::vector<OfferedComponent> offered_components(const PluginDescriptor& plugin) {
  std::vector<OfferedComponent> out;
  for (int i = 0; i < plugin.component_count; ++i) {
    const ComponentDescriptor& component = plugin.components[i];
    out.push_back({component.kind, component.name, component.description});
  }
  return out;
}

}  // namespace bowstring
