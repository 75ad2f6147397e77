#include "core/composition/parameters.hpp"

#include <cctype>
#include <cstddef>
#include <sstream>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/numbers.hpp"
#include "core/composition/profiles.hpp"
#include "core/composition/toml_text.hpp"

namespace bowstring {
namespace {

std::vector<std::string> split_choices(const char* choices) {
  std::vector<std::string> names;
  std::istringstream stream(choices == nullptr ? "" : choices);
  for (std::string name; std::getline(stream, name, '|');) names.push_back(name);
  return names;
}

/// What a parameter takes, for messages about a missing or mistyped one.
std::string expectation(const ParameterDeclaration& declaration) {
  const NumberRules rules(declaration);
  const std::string bounds = expected_bounds(declaration.lower, declaration.upper, declaration.lower_exclusive, "");
  switch (declaration.type) {
    case ParameterType::scalar:
      return expected_number(rules) +
             (*declaration.choices == '\0' ? "" : ", or " + quoted_alternatives(split_choices(declaration.choices)));
    case ParameterType::profile:
      return expected_number(rules) + ", or a table with 'table', 'segments' or 'column'";
    case ParameterType::vector:
      return "a list, each entry " + expected_number(rules);
    case ParameterType::path:
      return "text, the path of a file";
    case ParameterType::choice:
      return quoted_alternatives(split_choices(declaration.choices));
    case ParameterType::integer:
      return "a whole number" + (bounds.empty() ? "" : ", " + bounds);
    case ParameterType::flag:
      return "true or false";
    case ParameterType::text:
      return "text";
    case ParameterType::names:
      return "a name, or a list of names";
    case ParameterType::list:
      return "a list of tables";
  }
  return "";
}

/// `stiffness = "<number> N/mm"`, to be copied and filled in.
std::string assignment(const ParameterDeclaration& declaration) {
  const std::string key = std::string(declaration.key) + " = ";
  switch (declaration.type) {
    case ParameterType::scalar:
    case ParameterType::profile:
      return key + written_number(NumberRules(declaration));
    case ParameterType::vector:
      return key + "[" + written_number(NumberRules(declaration)) + ", …]";
    case ParameterType::path:
      return key + "\"<file>\"";
    case ParameterType::choice:
      return key + "\"" + split_choices(declaration.choices).front() + "\"";
    case ParameterType::integer:
      return key + "<whole number>";
    case ParameterType::flag:
      return key + "true";
    case ParameterType::text:
      return key + "\"<text>\"";
    case ParameterType::names:
      return key + "[\"<name>\", …]";
    case ParameterType::list:
      return key + "[{ … }]";
  }
  return key;
}

/// Reads one value of a declared parameter.
class ValueReader {
 public:
  ValueReader(const ParameterDeclaration& declaration, const SchemaOwner& owner, bool is_default, Status& schema_fault,
              Report& report)
      : declaration_(declaration),
        owner_(owner),
        is_default_(is_default),
        schema_fault_(schema_fault),
        report_(report),
        rules_(declaration),
        subject_("'" + std::string(declaration.key) + "' of " + owner.name) {
    rules_.bare_means_first = is_default;
  }

  std::optional<ParameterValue> read(const Node& node) {
    value_.key = declaration_.key;
    value_.type = declaration_.type;
    value_.given = !is_default_;
    value_.position = node.position.text();
    return read_as_declared(node) ? std::optional<ParameterValue>(std::move(value_)) : std::nullopt;
  }

 private:
  bool read_as_declared(const Node& node) {
    switch (declaration_.type) {
      case ParameterType::scalar:
        return read_scalar(node);
      case ParameterType::profile:
        return read_profile(node, subject_, rules_, value_, report_);
      case ParameterType::vector:
        return read_vector(node);
      case ParameterType::path:
        return read_path(node);
      case ParameterType::choice:
        return read_choice(node);
      case ParameterType::integer:
        return read_integer(node);
      case ParameterType::flag:
        return read_flag(node);
      case ParameterType::text:
        return read_text(node);
      case ParameterType::names:
        return read_names(node);
      case ParameterType::list:
        return read_list(node);
    }
    return false;
  }

  bool fail(const Node& node, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(node.position, found, expected, mend);
    return false;
  }

  bool fail_type(const Node& node) {
    return fail(node, subject_ + " is " + description(node), expectation(declaration_),
                "write " + assignment(declaration_));
  }

  bool read_scalar(const Node& node) {
    if (!node.text.empty() && contains_name(split_choices(declaration_.choices), node.text)) {
      value_.text = node.text;
      return true;
    }
    const bool is_word = !node.text.empty() && std::isalpha(static_cast<unsigned char>(node.text.front())) != 0;
    if (*declaration_.choices != '\0' && is_word) return fail_type(node);
    const std::optional<Number> number = read_number(node, subject_, rules_, report_);
    if (!number) return false;
    value_.number = number->value;
    value_.unit_alternative = number->alternative;
    return true;
  }

  bool read_vector(const Node& node) {
    if (!node.is_list()) return fail_type(node);
    bool good = true;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const std::string subject = "entry " + std::to_string(i + 1) + " of " + subject_;
      const std::optional<Number> number = read_number(node.items[i], subject, rules_, report_);
      good = number && same_unit(node.items[i], *number) && good;
      if (number) value_.vector.push_back(number->value);
    }
    return good;
  }

  bool same_unit(const Node& node, const Number& number) {
    if (value_.vector.empty()) value_.unit_alternative = number.alternative;
    if (number.alternative == value_.unit_alternative) return true;
    const std::string& unit = rules_.units[static_cast<std::size_t>(value_.unit_alternative)];
    return fail(node, subject_ + " mixes two kinds of unit", "every entry in " + unit, "write them all in one");
  }

  bool read_path(const Node& node) {
    if (!node.is_text() || node.text.empty()) return fail_type(node);
    const std::shared_ptr<const Source>& source = node.position.source;
    const std::filesystem::path written(node.text);
    value_.text = source ? (source->directory / written).lexically_normal().string() : node.text;
    return true;
  }

  bool read_choice(const Node& node) {
    const std::vector<std::string> choices = split_choices(declaration_.choices);
    value_.text = node.text;
    if (node.is_text() && contains_name(choices, node.text)) return true;
    const std::vector<std::string> near = nearest_names(node.text, choices);
    return fail(node, subject_ + " is " + description(node), expectation(declaration_),
                near.empty() ? "write one of them in quotes" : did_you_mean(near));
  }

  bool read_integer(const Node& node) {
    if (node.type != Node::Type::integer) return fail_type(node);
    value_.integer = node.integer;
    const auto number = static_cast<double>(node.integer);
    const bool low = declaration_.lower_exclusive ? number <= declaration_.lower : number < declaration_.lower;
    if (!low && number <= declaration_.upper) return true;
    return fail(node, subject_ + " is " + std::to_string(node.integer) + ", out of bounds",
                expected_bounds(declaration_.lower, declaration_.upper, declaration_.lower_exclusive, ""),
                std::string("write a ") + (low ? "larger" : "smaller") + " number");
  }

  bool read_flag(const Node& node) {
    if (node.type != Node::Type::flag) return fail_type(node);
    value_.flag = node.flag;
    return true;
  }

  bool read_text(const Node& node) {
    if (!node.is_text()) return fail_type(node);
    value_.text = node.text;
    return true;
  }

  bool read_names(const Node& node) {
    const std::vector<Node> single{node};
    for (const Node& item : node.is_list() ? node.items : single) {
      if (!item.is_text() || item.text.empty()) return fail_type(item);
      value_.names.push_back(item.text);
    }
    return true;
  }

  bool read_list(const Node& node) {
    if (!node.is_list()) return fail_type(node);
    bool good = true;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      SchemaOwner owner;
      owner.name = "entry " + std::to_string(i + 1) + " of " + subject_;
      owner.help = owner_.help;
      if (!check_is_table(node.items[i], owner.name, "write { … }", report_)) {
        good = false;
        continue;
      }
      const std::size_t count = static_cast<std::size_t>(declaration_.item_count);
      value_.items.push_back(
          read_parameters(node.items[i], owner, {declaration_.items, count}, schema_fault_, report_));
    }
    return good;
  }

  const ParameterDeclaration& declaration_;
  const SchemaOwner& owner_;
  bool is_default_;
  Status& schema_fault_;
  Report& report_;
  NumberRules rules_;
  std::string subject_;
  ParameterValue value_;
};

bool has_default(const ParameterDeclaration& declaration) {
  return declaration.default_text != nullptr && declaration.default_text[0] != '\0';
}

std::optional<ParameterValue> default_value(const ParameterDeclaration& declaration, const SchemaOwner& owner,
                                            Status& schema_fault) {
  Report faults;
  const Node node = read_value_or_text(declaration.default_text, {});
  std::optional<ParameterValue> value = ValueReader(declaration, owner, true, schema_fault, faults).read(node);
  if (!faults.empty()) {
    schema_fault = Status::failure(Code::failed, "the plugin of " + owner.name + " declares a default that its own " +
                                                     "schema refuses: " + faults.sorted().front().text());
  }
  return value;
}

}  // namespace

std::optional<ParameterValue> read_parameter(const Node& node, const ParameterDeclaration& declaration,
                                             const SchemaOwner& owner, Status& schema_fault, Report& report) {
  return ValueReader(declaration, owner, false, schema_fault, report).read(node);
}

ParameterSet read_parameters(const Node& table, const SchemaOwner& owner, Span<const ParameterDeclaration> schema,
                             Status& schema_fault, Report& report) {
  std::vector<std::string> known = owner.structural;
  for (const ParameterDeclaration& declaration : schema) {
    if (!contains_name(known, declaration.key)) known.push_back(declaration.key);
  }
  check_keys(table, owner.name, known, owner.later, owner.help, report);

  ParameterSet set;
  for (const ParameterDeclaration& declaration : schema) {
    if (contains_name(owner.structural, declaration.key)) continue;
    std::optional<ParameterValue> value;
    if (const Entry* entry = table.find(declaration.key)) {
      value = read_parameter(entry->value, declaration, owner, schema_fault, report);
    } else if (has_default(declaration)) {
      value = default_value(declaration, owner, schema_fault);
    } else if (declaration.default_text == nullptr) {
      report.error(table.position, owner.name + " has no '" + declaration.key + "'", expectation(declaration),
                   "add " + assignment(declaration));
    }
    if (value) set.values.push_back(std::move(*value));
  }
  return set;
}

}  // namespace bowstring
