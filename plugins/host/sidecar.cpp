#include "plugins/host/sidecar.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "plugins/host/elf.hpp"
#include "plugins/sdk/guard.hpp"

namespace bowstring {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string beside(const std::string& file, const std::string& relative) {
  return (fs::absolute(file).parent_path() / relative).lexically_normal().string();
}

Kind kind_in(const Json& entry) {
  const auto name = entry.at("kind").get<std::string>();
  if (const std::optional<Kind> kind = kind_called(name)) return *kind;
  throw StatusError(Code::failed, "it names an unknown kind '" + name + "'");
}

/// Hands the parsed file to `take`; what either throws becomes a status that names the file.
template <class Take>
Status read_json(const std::string& file, const char* what, Take&& take) {
  std::string text;
  Status status = read_bytes(file, text);
  if (status.ok()) status = guard([&] { take(Json::parse(text)); });
  if (status.ok()) return {};
  return Status::failure(Code::failed, std::string(what) + " '" + file + "' is of no use: " + status.text +
                                           "; the build writes it: run ninja again, or install the plugin again");
}

}  // namespace

std::optional<Kind> kind_called(std::string_view name) {
  for (int i = 0; i < kind_count; ++i) {
    if (name == kind_name(static_cast<Kind>(i))) return static_cast<Kind>(i);
  }
  return std::nullopt;
}

Status read_sidecar(const std::string& file, Sidecar& out) {
  return read_json(file, "plugin sidecar", [&](const Json& json) {
    out = {};
    out.library = beside(file, json.at("file").get<std::string>());
    out.interface_version = json.at("interface_version").get<std::uint32_t>();
    out.abi_tag = json.at("abi_tag").get<std::string>();
    for (const Json& entry : json.at("components")) {
      out.components.push_back(
          {kind_in(entry), entry.at("name").get<std::string>(), entry.at("description").get<std::string>()});
    }
  });
}

Status write_sidecar(const Sidecar& sidecar, const std::string& file) {
  return guard([&]() -> Status {
    Json json = {{"file", fs::relative(sidecar.library, fs::absolute(file).parent_path()).string()},
                 {"interface_version", sidecar.interface_version},
                 {"abi_tag", sidecar.abi_tag},
                 {"components", Json::array()}};
    for (const OfferedComponent& component : sidecar.components) {
      json["components"].push_back(
          {{"kind", kind_name(component.kind)}, {"name", component.name}, {"description", component.description}});
    }
    const std::string temporary = file + ".part" + std::to_string(::getpid());
    std::ofstream stream(temporary, std::ios::binary);
    stream << json.dump(2) << '\n';
    stream.close();
    if (!stream) {
      std::error_code ignored;
      fs::remove(temporary, ignored);
      return Status::failure(Code::failed, "cannot write '" + file + "'; check the folder and the room on its disk");
    }
    fs::rename(temporary, file);
    return {};
  });
}

Status read_plugin_list(const std::string& file, PluginList& out) {
  return read_json(file, "plugin list", [&](const Json& json) {
    out = {};
    for (const Json& entry : json.at("sidecars")) out.sidecars.push_back(beside(file, entry.get<std::string>()));
    for (const Json& entry : json.at("not_built")) {
      out.not_built.push_back({kind_in(entry), entry.at("name").get<std::string>(),
                               entry.at("option").get<std::string>(), entry.at("package").get<std::string>()});
    }
  });
}

}  // namespace bowstring
