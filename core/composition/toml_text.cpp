#include "core/composition/toml_text.hpp"

// toml++ asserts some of what a text may well have otherwise, a table whose name begins with '@' or 'é'; with NDEBUG it
// even tells the compiler that this cannot be. Both are left out: the error that it has for the case is reported.
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace bowstring {
namespace {

/// Copies toml++'s values into ours.
class Converter {
 public:
  explicit Converter(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

  Node convert(const toml::node& value) const {
    Node node;
    node.position = position(value.source());
    if (const toml::table* table = value.as_table()) {
      node.inline_table = table->is_inline();
      convert_entries(*table, node);
    } else if (const toml::array* list = value.as_array()) {
      node.type = Node::Type::list;
      for (const toml::node& item : *list) node.items.push_back(convert(item));
    } else {
      convert_scalar(value, node);
    }
    return node;
  }

 private:
  Position position(const toml::source_region& region) const {
    return {source_, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
  }

  /// toml++ sorts keys by name; the order of the text is that of their positions.
  void convert_entries(const toml::table& table, Node& node) const {
    for (const auto& [key, value] : table) {
      node.entries.push_back({std::string(key.str()), position(key.source()), convert(value)});
    }
    std::stable_sort(node.entries.begin(), node.entries.end(),
                     [](const Entry& a, const Entry& b) { return a.position.before(b.position); });
  }

  static void convert_scalar(const toml::node& value, Node& node) {
    if (const auto* text = value.as_string()) {
      node.type = Node::Type::text;
      node.text = text->get();
    } else if (const auto* integer = value.as_integer()) {
      node.type = Node::Type::integer;
      node.integer = static_cast<long>(integer->get());
    } else if (const auto* number = value.as_floating_point()) {
      node.type = Node::Type::number;
      node.number = number->get();
    } else if (const auto* flag = value.as_boolean()) {
      node.type = Node::Type::flag;
      node.flag = flag->get();
    } else {
      node.type = Node::Type::date;
    }
  }

  std::shared_ptr<const Source> source_;
};

std::string_view line_of(std::string_view text, int line) {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

/// toml++ reports a key that stands twice behind it; this is its first letter.
int column_of_key(std::string_view line, std::string_view key, int behind) {
  const std::size_t end = std::min(line.size(), static_cast<std::size_t>(std::max(behind, 1)) - 1 + key.size());
  const std::size_t place = line.substr(0, end).rfind(key);
  return place == std::string_view::npos ? behind : static_cast<int>(place) + 1;
}

/// "Error while parsing key-value pair: cannot redefine existing integer 'a'" without its first half.
std::string_view reason_of(std::string_view description) {
  constexpr std::string_view opening = "Error while parsing ";
  if (description.substr(0, opening.size()) != opening) return description;
  const std::size_t colon = description.find(": ");
  return colon == std::string_view::npos ? description : description.substr(colon + 2);
}

void report_syntax_error(const toml::parse_error& error, std::string_view text,
                         const std::shared_ptr<const Source>& source, Report& report) {
  Position position{source, static_cast<int>(error.source().begin.line), static_cast<int>(error.source().begin.column)};
  const std::string_view reason = reason_of(error.description());
  const std::size_t open = reason.find('\''), close = reason.rfind('\'');
  if (reason.substr(0, 15) == "cannot redefine" && open < close) {
    const std::string key(reason.substr(open + 1, close - open - 1));
    position.column = column_of_key(line_of(text, position.line), key, position.column);
    report.error(position, "duplicate key '" + key + "'", "each key once", "remove one of the two");
    return;
  }
  report.error(position, "not TOML: " + std::string(reason), "valid TOML",
               "mend this first: what stands behind it has not been read");
}

void move_to(Node& node, const Position& position) {
  node.position = position;
  for (Node& item : node.items) move_to(item, position);
  for (Entry& entry : node.entries) {
    entry.position = position;
    move_to(entry.value, position);
  }
}

}  // namespace

std::optional<Node> read_toml(std::string_view text, const std::shared_ptr<const Source>& source, Report& report) {
  try {
    const toml::table table = toml::parse(text);
    return Converter(source).convert(table);
  } catch (const toml::parse_error& error) {
    report_syntax_error(error, text, source, report);
    return std::nullopt;
  }
}

Node read_value_or_text(const std::string& text, const Position& position) {
  Report ignored;
  std::optional<Node> table = read_toml("value = " + text, position.source, ignored);
  if (!table || table->entries.size() != 1) return text_node(text, position);
  Node value = std::move(table->entries.front().value);
  move_to(value, position);
  return value;
}

}  // namespace bowstring
