#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// A file with its bases and overrides, put together.
struct SourceTree {
  Node root;  ///< without `schema`, `base`, `plugin-path`, `set` and `step`
  std::vector<StepTable> steps;
  std::vector<std::string> plugin_path;  ///< absolute; the file's own before its bases'
  std::vector<std::string> files;        ///< that have been read, absolute
};

/// Reads the file and, recursively, its `base`. A file's tables are laid over those of its base (entries of a list
/// are added, keys of a table replace), then its [set] is applied, then the request's overrides, then those of the
/// steps up to the request's. Empty where a file cannot be read at all; what else is wrong goes into the report.
std::optional<SourceTree> read_sources(const CompositionRequest& request, Report& report);

}  // namespace bowstring
