#pragma once

#include <string>
#include <vector>

#include "plugins/host/plugin_host.hpp"
#include "study/plan/plan.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::testing {

/// A study over a small rod, in a folder of its own: rod.toml, study.toml.
class SmallStudy {
 public:
  /// `text` comes after `schema` and `base`.
  explicit SmallStudy(const std::string& text, const std::string& opening = "schema = 1\nbase = \"rod.toml\"\n");

  /// Of a study without errors.
  study::Plan plan(bool reduced = false);
  /// Every error, without the folder's name, one line each.
  std::string errors();

  /// One line per run: its labels, "1 N/20".
  std::vector<std::string> runs();

  const TemporaryFolder& folder() const { return folder_; }
  std::string file() const { return folder_.path() + "/study.toml"; }

 private:
  TemporaryFolder folder_;
  PluginHost host_;
};

}  // namespace bowstring::testing
