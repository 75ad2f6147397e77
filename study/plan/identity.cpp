#include "study/plan/identity.hpp"

#include <nlohmann/json.hpp>

#include "core/composition/read_file.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring::study {
namespace {

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

}  // namespace

const std::string& Identity::content(const std::string& file) {
  const auto [place, fresh] = content_.emplace(file, "");
  if (std::string bytes; fresh && read_file(file, bytes).empty()) place->second = sha256_hex(bytes);
  return place->second;
}

std::string Identity::of(const Composition& composition, const Provenance& provenance, const std::string& predecessor) {
  std::string text = composition.resolved_json;
  for (const std::string& file : data_files_of(composition)) {
    replace_all(text, nlohmann::json(file).dump(), "\"sha256:" + content(file) + "\"");
  }
  text += "\nkernel " + provenance.kernel_sha256;
  for (const PluginProvenance& plugin : provenance.plugins) {
    text += std::string("\n") + kind_name(plugin.kind) + "/" + plugin.name + " " + plugin.origin.sha256;
  }
  return sha256_hex(text + "\nfrom " + predecessor);
}

}  // namespace bowstring::study
