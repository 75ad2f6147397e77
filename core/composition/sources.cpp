#include "core/composition/sources.hpp"

#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "core/composition/override.hpp"
#include "core/composition/read_file.hpp"
#include "core/composition/sequences.hpp"
#include "core/composition/toml_text.hpp"
#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

namespace fs = std::filesystem;

constexpr long schema_version = 1;
constexpr int order_of_overrides = 1 << 20;

fs::path absolute_path(const std::string& file) {
  std::error_code ignored;
  const fs::path path = fs::absolute(file, ignored);
  return path.empty() ? fs::path(file) : path.lexically_normal();
}

/// One path for every way to write it, so that a file is recognised.
fs::path canonical_path(const std::string& file) {
  std::error_code ignored;
  const fs::path path = fs::weakly_canonical(absolute_path(file), ignored);
  return path.empty() ? absolute_path(file) : path;
}

/// Reads a chain of files, each the base of the one before.
class ChainReader {
 public:
  explicit ChainReader(Report& report) : report_(report) {}

  /// `from`: where the file is named; nowhere for the user's own file. `text`: in the file's place.
  std::optional<SourceTree> read(const std::string& file, const Position& from,
                                 const std::optional<std::string>& text = std::nullopt) {
    const auto source = std::make_shared<Source>();
    source->name = file;
    source->order = static_cast<int>(chain_.size());
    source->directory = absolute_path(file).parent_path();

    std::string content;
    if (text) {
      content = *text;
    } else if (const std::string why = read_file(file, content); !why.empty()) {
      report_unreadable(file, from, why);
      return std::nullopt;
    }
    chain_.push_back({file, text ? fs::path() : canonical_path(file)});
    std::optional<Node> root = read_toml(content, source, report_);
    if (!root) return std::nullopt;
    return compose(std::move(*root));
  }

 private:
  struct Link {
    std::string name;
    fs::path canonical;  // "" of a text in no file
  };

  void report_unreadable(const std::string& file, const Position& from, const std::string& problem) {
    if (from.source == nullptr) {
      const Position whole{std::make_shared<Source>(Source{file, {}, 0}), 0, 0};
      report_.error(whole, "cannot read the file (" + problem + ")", "a composition in TOML", "check the path");
    } else {
      report_.error(from, "cannot read the base '" + file + "' (" + problem + ")", "a composition in TOML",
                    "paths are relative to the file that they stand in");
    }
  }

  std::optional<SourceTree> compose(Node root) {
    check_schema(root);
    SourceTree result;
    if (!chain_.back().canonical.empty()) result.files.push_back(chain_.back().canonical.string());
    read_plugin_path(root, result.plugin_path);
    if (const Entry* base = root.find("base")) {
      std::optional<SourceTree> below = read_base(base->value);
      if (!below) return std::nullopt;
      result.root = std::move(below->root);
      append(result.plugin_path, below->plugin_path);
      append(result.files, below->files);
    }
    result.root.position = root.position;
    lay_over(result.root, root);
    if (const Entry* set = root.find("set")) apply_set(result.root, set->value);
    return result;
  }

  void check_schema(const Node& root) {
    const Entry* schema = root.find("schema");
    if (schema == nullptr) {
      report_.error(root.position, "the file has no 'schema'", "the version of the format that it is written in",
                    "add schema = 1 at the top");
    } else if (schema->value.type != Node::Type::integer || schema->value.integer != schema_version) {
      report_.error(schema->value.position, "'schema' is " + description(schema->value), "1",
                    "write schema = 1; this version reads no other");
    }
  }

  void read_plugin_path(const Node& root, std::vector<std::string>& out) {
    const Entry* entry = root.find("plugin-path");
    if (entry == nullptr) return;
    const std::vector<Node> single{entry->value};
    for (const Node& item : entry->value.is_list() ? entry->value.items : single) {
      if (item.is_text()) {
        out.push_back((item.position.source->directory / item.text).lexically_normal().string());
      } else {
        report_.error(item.position, "'plugin-path' has " + description(item), "a folder, or a list of folders",
                      "write plugin-path = [\"folder\"]");
      }
    }
  }

  std::optional<SourceTree> read_base(const Node& base) {
    if (!base.is_text()) {
      report_.error(base.position, "'base' is " + description(base), "a file", "write base = \"other.toml\"");
      return std::nullopt;
    }
    const std::string file = (fs::path(chain_.back().name).parent_path() / base.text).lexically_normal().string();
    const fs::path canonical = canonical_path(file);
    std::string loop;
    for (const Link& link : chain_) {
      if (!loop.empty() || link.canonical == canonical) loop += "'" + link.name + "' → ";
    }
    if (!loop.empty()) {
      report_.error(base.position, "the bases go round in a circle: " + loop + "'" + file + "'",
                    "a chain of files that ends", "take `base` out of one of them");
      return std::nullopt;
    }
    return read(file, base.position);
  }

  static void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
    to.insert(to.end(), more.begin(), more.end());
  }

  static bool is_settled(const std::string& key) {
    return key == "schema" || key == "base" || key == "plugin-path" || key == "set";
  }

  static void lay_over(Node& below, const Node& above) {
    for (const Entry& entry : above.entries) {
      if (is_settled(entry.key)) continue;
      Entry* present = below.find(entry.key);
      if (present != nullptr && present->value.is_list() && entry.value.is_list()) {
        for (const Node& item : entry.value.items) present->value.items.push_back(item);
      } else if (present != nullptr && present->value.is_table() && entry.value.is_table()) {
        for (const Entry& inner : entry.value.entries) present->value.set(inner);
      } else {
        below.set(entry);
      }
    }
  }

  void apply_set(Node& root, const Node& set) {
    if (!set.is_table()) {
      report_.error(set.position, "'set' is " + description(set), "a table of paths",
                    "write [set] with lines like \"solver.tolerance\" = 1e-9");
      return;
    }
    for (const Entry& entry : set.entries) {
      if (entry.value.is_table() && !entry.value.inline_table) {
        report_.error(entry.position, "'" + entry.key + "' in [set] opens a table",
                      "a whole path in quotes, with a value or an inline table { … }",
                      "write it as in \"solver.tolerance\" = 1e-9");
      } else {
        apply_override(root, entry.key, entry.position, entry.value, report_);
      }
    }
  }

  Report& report_;
  std::vector<Link> chain_;
};

void apply_requested(Node& root, const Override& one, int order, Report& report) {
  const auto source = std::make_shared<Source>();
  source->name = one.position.empty() ? "--set " + one.path + "=" + one.value : one.position;
  source->directory = absolute_path(one.directory.empty() ? "." : one.directory);
  source->order = order_of_overrides + order;
  const Position position{source, 0, 0};
  apply_override(root, one.path, position, read_value_or_text(one.value, position), report);
}

void apply_request(SourceTree& tree, const CompositionRequest& request, Report& report) {
  int order = 0;
  for (const Override& one : request.overrides) {
    if (!one.after_steps) apply_requested(tree.root, one, order++, report);
  }
  tree.steps = read_steps(tree.root, report);
  apply_steps(tree.root, request.step, report);
  for (const Override& one : request.overrides) {
    if (one.after_steps) apply_requested(tree.root, one, order++, report);
  }
}

}  // namespace

std::optional<SourceTree> read_sources(const CompositionRequest& request, Report& report) {
  std::optional<SourceTree> tree = ChainReader(report).read(request.file, {}, request.text);
  if (tree) apply_request(*tree, request, report);
  return tree;
}

}  // namespace bowstring
