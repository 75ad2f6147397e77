#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/interfaces/registry.hpp"
#include "plugins/host/sidecar.hpp"

namespace bowstring {

/// The running binary's own file.
std::string running_executable();

/// Where plugins are looked for, in this order. Each entry is a folder: the sidecars in it are taken, and those that
/// a `bowstring-plugins.json` in it lists. The working directory counts only where an entry names it.
struct PluginHostOptions {
  std::vector<std::string> command_line_path;  ///< --plugin-path
  std::vector<std::string> composition_path;   ///< `plugin-path` of the composition, absolute
  std::string environment_path;                ///< BOWSTRING_PLUGIN_PATH: folders separated by colons
  /// The binary whose own plugins come last. One that has none, a program of somebody else's, gets those that were
  /// built or installed with this library. "": none at all.
  std::string executable_path = running_executable();
};

/// Where the command looks: `BOWSTRING_PLUGIN_PATH` of the environment, then what belongs to the binary or the library,
/// all of it after `composition_path`.
PluginHostOptions plugin_search(std::vector<std::string> composition_path = {});

/// Finds plugins by their sidecars and opens a library only when one of its components is asked for. Before that its
/// ABI tag is compared, in the sidecar and in the file. Libraries stay open. One host may serve any number of threads
/// at once, and what it has answered is valid for the rest of the process.
class PluginHost final : public Registry {
 public:
  explicit PluginHost(const PluginHostOptions& options = plugin_search());

  std::vector<std::string> names(Kind kind) const override;
  /// `failed` also where two libraries offer the name, and for a plugin of this project that was not built.
  const ComponentDescriptor* find(Kind kind, const std::string& name, Status& status) override;
  /// Empty for a name that nobody offers; `sha256` empty where the file cannot be read, which is done once.
  ComponentOrigin origin(Kind kind, const std::string& name) const override;

  /// One sentence, from the sidecar; "" for a name that nobody offers.
  std::string description(Kind kind, const std::string& name) const;
  const std::vector<PluginNotBuilt>& not_built() const noexcept { return not_built_; }
  /// What discovery could not use, as sentences: folders that do not exist, sidecars that cannot be read, names
  /// that two libraries offer.
  const std::vector<std::string>& problems() const noexcept { return problems_; }

 private:
  struct Library {
    Sidecar sidecar;
    std::string sidecar_file;
    const PluginDescriptor* open = nullptr;
    mutable std::optional<std::string> sha256;
  };
  using Name = std::pair<Kind, std::string>;

  void search_folder(const std::string& path);
  bool search_binary(const std::string& executable);
  void search_library();
  void take_list(const std::string& file);
  void take_sidecar(const std::string& path);
  void note_duplicates();

  const std::vector<std::size_t>* offering(Kind kind, const std::string& name) const;
  Status unknown(Kind kind, const std::string& name) const;
  Status duplicate(const Name& name, const std::vector<std::size_t>& libraries) const;
  Status open(Library& library);

  std::vector<std::string> folders_;
  std::vector<Library> libraries_;
  std::map<Name, std::vector<std::size_t>> offers_;  ///< indices into libraries_
  std::vector<PluginNotBuilt> not_built_;
  std::vector<std::string> problems_;
  /// Guards Library::open and Library::sha256, the only things that change after the constructor.
  mutable std::mutex opening_;
};

}  // namespace bowstring
