#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/scene.hpp"

namespace bowstring::apps {

/// Where results go: `--out FILE` and every `--write WRITER=FILE`. All are written, or none is.
class Outputs {
 public:
  /// Finds the writers and looks at the places before anything is solved: what cannot be written, or stands there
  /// twice, is reported on stderr. Returns an exit code.
  int prepare(const std::optional<std::string>& out, const std::vector<std::string>& write, Registry& registry);

  /// The same for places where an input stands. `reader` is who reads it: "this composition". Returns an exit code.
  int spare(const std::vector<std::string>& input_files, const char* reader = "this composition") const;

  /// Writes everything beside its place, then renames. Returns an exit code: that of a place which cannot be written
  /// any more, or of a writer that fails, both reported on stderr.
  int write(const std::string& document) const;

 private:
  struct Target {
    std::string label;  ///< as on the command line: "--out", "--write svg=picture.svg"
    std::string file;
    ComponentChoice writer;  ///< without descriptor: the document itself
  };

  int check_places() const;

  std::vector<Target> targets_;
};

}  // namespace bowstring::apps
