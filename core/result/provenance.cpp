#include "core/result/provenance.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/read_file.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring {
namespace {

/// The file that this code was loaded from, and its sha256, once for the process.
const std::pair<std::string, std::string>& kernel() {
  static const std::pair<std::string, std::string> found = [] {
    std::pair<std::string, std::string> out;
    Dl_info self;
    const auto* here = reinterpret_cast<const void*>(&provenance_of);
    if (::dladdr(here, &self) == 0 || self.dli_fname == nullptr) return out;
    std::error_code error;
    const std::filesystem::path file = std::filesystem::canonical(self.dli_fname, error);
    out.first = error ? self.dli_fname : file.string();
    std::string bytes;
    if (read_file(out.first, bytes).empty()) out.second = sha256_hex(bytes);
    return out;
  }();
  return found;
}

}  // namespace

Provenance provenance_of(const Composition& composition, const Registry& registry) {
  Provenance out{bowstring_version, interface_version, kernel().first, kernel().second, {}};
  std::set<std::pair<Kind, std::string>> named;
  for (const ComponentChoice* choice : components_of(composition)) named.emplace(choice->kind, choice->name);
  for (const auto& [kind, name] : named) out.plugins.push_back({kind, name, registry.origin(kind, name)});
  return out;
}

std::string provenance_json(const Provenance& provenance) {
  using Json = nlohmann::ordered_json;
  Json plugins = Json::array();
  for (const PluginProvenance& plugin : provenance.plugins) {
    plugins.push_back({{"kind", kind_name(plugin.kind)},
                       {"name", plugin.name},
                       {"file", plugin.origin.file},
                       {"sha256", plugin.origin.sha256},
                       {"abi_tag", plugin.origin.abi_tag}});
  }
  const Json document = {{"version", provenance.version},
                         {"interface_version", provenance.interface_version},
                         {"kernel", {{"file", provenance.kernel_file}, {"sha256", provenance.kernel_sha256}}},
                         {"plugins", std::move(plugins)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace bowstring
