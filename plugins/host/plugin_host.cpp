#include "plugins/host/plugin_host.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/composition/nearest.hpp"
#include "plugins/host/elf.hpp"
#include "plugins/host/library.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring {

namespace {

namespace fs = std::filesystem;

/// Absolute, with links followed as far as the path exists, so that one file has one name.
std::string canonical_name(const fs::path& path) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(path, error);
  return (error ? fs::absolute(path).lexically_normal() : out).string();
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    if (end > begin) out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string quoted(Kind kind, const std::string& name) { return std::string(kind_name(kind)) + " '" + name + "'"; }

}  // namespace

std::string running_executable() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

PluginHostOptions plugin_search(std::vector<std::string> composition_path) {
  PluginHostOptions options;
  options.composition_path = std::move(composition_path);
  if (const char* environment = std::getenv("BOWSTRING_PLUGIN_PATH")) options.environment_path = environment;
  return options;
}

PluginHost::PluginHost(const PluginHostOptions& options) {
  for (const std::string& folder : options.command_line_path) search_folder(folder);
  for (const std::string& folder : options.composition_path) search_folder(folder);
  for (const std::string& folder : split(options.environment_path, ':')) search_folder(folder);
  if (!options.executable_path.empty() && !search_binary(options.executable_path)) search_library();
  note_duplicates();
}

bool PluginHost::search_binary(const std::string& executable) {
  const fs::path folder = fs::path(executable).parent_path();
  const fs::path list = folder / plugin_list_name;
  const fs::path installed = folder / BOWSTRING_PLUGINS_FROM_BINARY;
  std::error_code error;
  if (fs::exists(list, error)) {
    folders_.push_back(canonical_name(folder));
    take_list(list.string());
  } else if (fs::exists(installed, error)) {
    search_folder(installed.string());
  } else {
    return false;
  }
  return true;
}

/// An installed library stands above its plugins, that of a build two folders below the build's list.
void PluginHost::search_library() {
  Dl_info self;
  const auto* here = reinterpret_cast<const void*>(&running_executable);
  if (::dladdr(here, &self) == 0 || self.dli_fname == nullptr) return;
  const fs::path folder = fs::path(canonical_name(self.dli_fname)).parent_path();
  const fs::path installed = folder / BOWSTRING_PLUGINS_FROM_LIBRARY;
  std::error_code error;
  if (fs::exists(installed, error)) {
    search_folder(installed.string());
  } else {
    search_binary((folder.parent_path().parent_path() / "bowstring").string());
  }
}

void PluginHost::search_folder(const std::string& path) {
  const std::string folder = canonical_name(path);
  if (std::find(folders_.begin(), folders_.end(), folder) != folders_.end()) return;
  folders_.push_back(folder);
  std::error_code error;
  std::vector<std::string> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    files.push_back(entry->path().string());
  }
  if (error) {
    problems_.push_back("plugin folder '" + folder + "' cannot be searched: " + error.message());
    return;
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    if (ends_with(file, sidecar_suffix)) take_sidecar(file);
    if (fs::path(file).filename() == plugin_list_name) take_list(file);
  }
}

void PluginHost::take_list(const std::string& file) {
  PluginList list;
  if (Status status = read_plugin_list(file, list); !status.ok()) {
    problems_.push_back(status.text);
    return;
  }
  for (const std::string& sidecar : list.sidecars) take_sidecar(sidecar);
  not_built_.insert(not_built_.end(), list.not_built.begin(), list.not_built.end());
}

void PluginHost::take_sidecar(const std::string& path) {
  Library library;
  library.sidecar_file = canonical_name(path);
  if (Status status = read_sidecar(library.sidecar_file, library.sidecar); !status.ok()) {
    problems_.push_back(status.text);
    return;
  }
  library.sidecar.library = canonical_name(library.sidecar.library);
  for (const Library& other : libraries_) {
    if (other.sidecar.library == library.sidecar.library) return;
  }
  for (const OfferedComponent& component : library.sidecar.components) {
    offers_[{component.kind, component.name}].push_back(libraries_.size());
  }
  libraries_.push_back(std::move(library));
}

void PluginHost::note_duplicates() {
  for (const auto& [name, libraries] : offers_) {
    if (libraries.size() > 1) problems_.push_back(duplicate(name, libraries).text);
  }
}

const std::vector<std::size_t>* PluginHost::offering(Kind kind, const std::string& name) const {
  const auto found = offers_.find({kind, name});
  return found != offers_.end() ? &found->second : nullptr;
}

std::vector<std::string> PluginHost::names(Kind kind) const {
  std::vector<std::string> out;
  for (const auto& [name, libraries] : offers_) {
    if (name.first == kind) out.push_back(name.second);
  }
  return out;
}

const ComponentDescriptor* PluginHost::find(Kind kind, const std::string& name, Status& status) {
  const std::vector<std::size_t>* libraries = offering(kind, name);
  if (libraries == nullptr) {
    status = unknown(kind, name);
    return nullptr;
  }
  if (libraries->size() > 1) {
    status = duplicate({kind, name}, *libraries);
    return nullptr;
  }
  Library& library = libraries_[libraries->front()];
  const std::lock_guard<std::mutex> lock(opening_);
  status = open(library);
  if (!status.ok()) return nullptr;
  for (int i = 0; i < library.open->component_count; ++i) {
    const ComponentDescriptor& component = library.open->components[i];
    if (component.kind == kind && component.name == name) return &component;
  }
  return nullptr;  // not reached: `open` compared the list of components with the sidecar's
}

Status PluginHost::open(Library& library) {
  if (library.open != nullptr) return {};
  const Sidecar& sidecar = library.sidecar;
  if (Status status = check_abi(sidecar.library, sidecar.abi_tag, "its sidecar"); !status.ok()) return status;
  if (Status status = check_library_file(sidecar.library); !status.ok()) return status;
  const PluginDescriptor* plugin = nullptr;
  if (Status status = open_library(sidecar.library, &plugin); !status.ok()) return status;
  if (sidecar.interface_version != plugin->interface_version || sidecar.components != offered_components(*plugin)) {
    return Status::failure(Code::failed, "plugin library '" + sidecar.library + "' is not what its sidecar '" +
                                             library.sidecar_file +
                                             "' says; write the sidecar again with ninja or "
                                             "bowstring-sidecar, or install the two together");
  }
  library.open = plugin;
  return {};
}

Status PluginHost::unknown(Kind kind, const std::string& name) const {
  for (const PluginNotBuilt& plugin : not_built_) {
    if (plugin.kind != kind || plugin.name != name) continue;
    return Status::failure(Code::failed, "plugin " + std::string(kind_name(kind)) + "/" + name +
                                             " is known but was not built; install " + plugin.package +
                                             " and configure the build with -D" + plugin.option + "=enabled");
  }
  const std::vector<std::string> known = names(kind);
  std::string text = "no plugin offers " + quoted(kind, name);
  if (known.empty()) {
    text += "; no " + std::string(kind_name(kind)) + " was found at all in " +
            (folders_.empty() ? "an empty search path" : comma_separated(folders_)) +
            "; name the folder of the plugins with --plugin-path or BOWSTRING_PLUGIN_PATH";
  } else {
    text += "; expected one of: " + comma_separated(known);
    if (const std::string hint = did_you_mean(nearest_names(name, known)); !hint.empty()) text += "; " + hint;
  }
  for (const auto& [other, libraries] : offers_) {
    if (other.second == name) text += "; there is " + quoted(other.first, name);
  }
  for (const std::string& problem : problems_) text += "; note that " + problem;
  return Status::failure(Code::invalid_input, text);
}

Status PluginHost::duplicate(const Name& name, const std::vector<std::size_t>& libraries) const {
  std::string files;
  for (const std::size_t i : libraries) files += (files.empty() ? "'" : " and '") + libraries_[i].sidecar.library + "'";
  return Status::failure(Code::failed, quoted(name.first, name.second) + " is offered by " + files +
                                           "; remove one of them from the plugin path, or rename its component");
}

ComponentOrigin PluginHost::origin(Kind kind, const std::string& name) const {
  const std::vector<std::size_t>* libraries = offering(kind, name);
  if (libraries == nullptr) return {};
  const Library& library = libraries_[libraries->front()];
  const std::lock_guard<std::mutex> lock(opening_);
  if (!library.sha256) {
    std::string bytes;
    library.sha256 = read_bytes(library.sidecar.library, bytes).ok() ? sha256_hex(bytes) : "";
  }
  return {library.sidecar.library, *library.sha256, library.sidecar.abi_tag};
}

std::string PluginHost::description(Kind kind, const std::string& name) const {
  const std::vector<std::size_t>* libraries = offering(kind, name);
  if (libraries == nullptr) return "";
  for (const OfferedComponent& component : libraries_[libraries->front()].sidecar.components) {
    if (component.kind == kind && component.name == name) return component.description;
  }
  return "";
}

}  // namespace bowstring
