#include "core/result/provenance.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/json_words.hpp"
#include "core/composition/read_file.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring {
namespace {

/// The file that this code was loaded from, and its sha256, once for the process.
const std::pair<std::string, std::string>& kernel() {
  static const std::pair<std::string, std::string> found = [] {
    std::pair<std::string, std::string> out;
    Dl_info self;
    const auto* here = reinterpret_cast<const void*>(&provenance_here);
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

Provenance of_kernel() { return {bowstring_version, interface_version, kernel().first, kernel().second, {}}; }

using Json = nlohmann::ordered_json;

std::string shortened(const std::string& sha256) {
  constexpr std::size_t telling = 12;
  if (sha256.empty()) return "unknown";
  return sha256.size() > telling ? sha256.substr(0, telling) + "…" : sha256;
}

/// "sha256 ab12… then, cd34… here".
std::string two(const std::string& what, const std::string& a, const std::string& b, const SideNames& names) {
  return what + " " + a + " " + names.first + ", " + b + " " + names.second;
}

std::string in_brackets(const std::string& file) { return file.empty() ? "" : " (" + file + ")"; }

/// One side has no library, or one that cannot be read.
std::string absence(const PluginProvenance& a, const PluginProvenance& b, const SideNames& names) {
  const bool first = a.origin.file.empty() || a.origin.sha256.empty();
  const ComponentOrigin& lacking = first ? a.origin : b.origin;
  const ComponentOrigin& other = first ? b.origin : a.origin;
  const std::string& where = first ? names.first : names.second;
  const std::string& elsewhere = first ? names.second : names.first;
  std::string out = lacking.file.empty() ? "offered by no library " + where
                                         : "its library '" + lacking.file + "' cannot be read " + where;
  if (!other.file.empty()) out += ", sha256 " + shortened(other.sha256) + " " + elsewhere + in_brackets(other.file);
  return out;
}

std::string plugin_difference(const PluginProvenance& a, const PluginProvenance& b, const SideNames& names) {
  if (a.origin.sha256 == b.origin.sha256 && a.origin.abi_tag == b.origin.abi_tag &&
      a.origin.file.empty() == b.origin.file.empty()) {
    return "";
  }
  std::string out = "plugin " + std::string(kind_name(a.kind)) + "/" + a.name + ": ";
  if (a.origin.sha256.empty() || b.origin.sha256.empty()) return out + absence(a, b, names);
  std::string facts;
  if (a.origin.sha256 != b.origin.sha256) {
    facts = two("sha256", shortened(a.origin.sha256), shortened(b.origin.sha256), names);
  }
  if (a.origin.abi_tag != b.origin.abi_tag) {
    facts +=
        (facts.empty() ? "" : "; ") + two("ABI tag", "'" + a.origin.abi_tag + "'", "'" + b.origin.abi_tag + "'", names);
  }
  return out + facts + in_brackets(b.origin.file);
}

}  // namespace

Provenance provenance_here(const Provenance& recorded, const Registry& registry) {
  Provenance out = of_kernel();
  for (const PluginProvenance& plugin : recorded.plugins) {
    out.plugins.push_back({plugin.kind, plugin.name, registry.origin(plugin.kind, plugin.name)});
  }
  return out;
}

Provenance provenance_of(const Composition& composition, const Registry& registry) {
  return provenance_of(components_of(composition), registry);
}

Provenance provenance_of(const std::vector<const ComponentChoice*>& chosen, const Registry& registry) {
  Provenance out = of_kernel();
  std::set<std::pair<Kind, std::string>> named;
  for (const ComponentChoice* choice : chosen) named.emplace(choice->kind, choice->name);
  for (const auto& [kind, name] : named) out.plugins.push_back({kind, name, registry.origin(kind, name)});
  return out;
}

Provenance read_provenance(const std::string& json) {
  const Json document = Json::parse(json);
  Provenance out;
  out.version = text_of(document, "version");
  if (const auto found = document.find("interface_version"); found != document.end() && found->is_number_integer()) {
    out.interface_version = found->get<std::uint32_t>();
  }
  if (const auto found = document.find("kernel"); found != document.end() && found->is_object()) {
    out.kernel_file = text_of(*found, "file");
    out.kernel_sha256 = text_of(*found, "sha256");
  }
  const auto plugins = document.find("plugins");
  if (plugins == document.end() || !plugins->is_array()) return out;
  for (const Json& entry : *plugins) {
    if (!entry.is_object()) continue;
    for (int kind = 0; kind < kind_count; ++kind) {
      if (text_of(entry, "kind") != kind_name(static_cast<Kind>(kind))) continue;
      out.plugins.push_back({static_cast<Kind>(kind),
                             text_of(entry, "name"),
                             {text_of(entry, "file"), text_of(entry, "sha256"), text_of(entry, "abi_tag")}});
    }
  }
  return out;
}

std::vector<std::string> provenance_differences(const Provenance& a, const Provenance& b, const SideNames& names) {
  std::vector<std::string> out;
  const auto known = [](const std::string& text) { return text.empty() ? "unknown" : text; };
  if (a.version != b.version) out.push_back(two("version", known(a.version), known(b.version), names));
  if (a.interface_version != b.interface_version) {
    out.push_back(two("interface of plugins: version", std::to_string(a.interface_version),
                      std::to_string(b.interface_version), names));
  }
  if (a.kernel_sha256 != b.kernel_sha256) {
    out.push_back("kernel: " + two("sha256", shortened(a.kernel_sha256), shortened(b.kernel_sha256), names) +
                  in_brackets(b.kernel_file));
  }
  for (const PluginProvenance& plugin : a.plugins) {
    for (const PluginProvenance& other : b.plugins) {
      if (plugin.kind != other.kind || plugin.name != other.name) continue;
      if (std::string difference = plugin_difference(plugin, other, names); !difference.empty()) {
        out.push_back(std::move(difference));
      }
    }
  }
  return out;
}

std::string provenance_json(const Provenance& provenance) {
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
