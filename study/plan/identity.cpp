#include "study/plan/identity.hpp"

#include <nlohmann/json.hpp>

#include "core/composition/read_file.hpp"
#include "core/composition/sha256.hpp"
#include "study/plan/replace_all.hpp"

namespace bowstring::study {
const std::string& Identity::content(const std::string& file) {
  const auto [place, fresh] = content_.emplace(file, "");
  if (std::string bytes; fresh && read_file(file, bytes).empty()) place->second = sha256_hex(bytes);
  return place->second;
}

std::string Identity::of(const std::vector<Composition>& states, const Provenance& provenance,
                         const std::string& predecessor) {
  std::string text = states.front().resolved_json;
  for (const Composition& state : states) {
    for (const std::string& file : data_files_of(state)) {
      const std::string written = nlohmann::json(file).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      replace_all(text, written, "\"sha256:" + content(file) + "\"");
    }
  }
  text += "\nkernel " + provenance.kernel_sha256;
  for (const PluginProvenance& plugin : provenance.plugins) {
    text += std::string("\n") + kind_name(plugin.kind) + "/" + plugin.name + " " + plugin.origin.sha256;
  }
  return sha256_hex(text + "\nfrom " + predecessor);
}

}  // namespace bowstring::study
