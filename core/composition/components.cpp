#include "core/composition/components.hpp"

#include <cstddef>
#include <optional>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/parameters.hpp"

namespace bowstring {
namespace {

std::string with_article(Kind kind) {
  const std::string name = kind_name(kind);
  return (std::string("aeiou").find(name[0]) != std::string::npos ? "an " : "a ") + name;
}

/// "'spline' is a geometry, not an energy" where another kind has the name; else "".
std::string other_kind(const std::string& name, Kind wanted, const Registry& registry) {
  for (int i = 0; i < kind_count; ++i) {
    const auto kind = static_cast<Kind>(i);
    if (kind != wanted && contains_name(registry.names(kind), name)) {
      return "'" + name + "' is " + with_article(kind) + ", not " + with_article(wanted);
    }
  }
  return "";
}

void report_unknown(const std::string& name, const Node& table, const ComponentUse& use, Reading& reading) {
  const std::string kind = kind_name(use.kind);
  const std::vector<std::string> names = reading.registry.names(use.kind);
  const std::vector<std::string> near = nearest_names(name, names);
  std::string mend = other_kind(name, use.kind, reading.registry);
  if (!near.empty()) mend += (mend.empty() ? "" : "; ") + did_you_mean(near);
  if (mend.empty()) mend = "`bowstring plugins " + kind + "` says what is installed";
  const Entry* type = table.find("type");
  reading.report.error(type != nullptr ? type->value.position : table.position,
                       "unknown " + kind + " '" + name + "'" + (type != nullptr ? "" : ", the default of " + use.owner),
                       names.empty() ? "an installed " + kind + ", but none is" : "one of: " + comma_separated(names),
                       mend);
}

/// The name of the plugin; empty where the report has got an error.
std::optional<std::string> type_of(const Node& table, const ComponentUse& use, Reading& reading) {
  const Entry* type = table.find("type");
  if (type == nullptr && !use.default_type.empty()) return use.default_type;
  const std::string kind = kind_name(use.kind);
  if (type == nullptr) {
    const std::vector<std::string> names = reading.registry.names(use.kind);
    reading.report.error(table.position, use.owner + " has no 'type'",
                         names.empty() ? "the name of " + with_article(use.kind) : "one of: " + comma_separated(names),
                         "add type = \"<" + kind + ">\"");
    return std::nullopt;
  }
  if (type->value.is_text()) return type->value.text;
  reading.report.error(type->value.position, "'type' of " + use.owner + " is " + description(type->value),
                       "the name of " + with_article(use.kind) + " in quotes",
                       "`bowstring plugins " + kind + "` says what is installed");
  return std::nullopt;
}

}  // namespace

void Reading::keep_failure(const Status& status) {
  if (!status.ok() && plugin_failure.ok()) plugin_failure = Status::failure(Code::failed, status.text);
}

ComponentChoice read_component(const Node& table, const ComponentUse& use, Reading& reading) {
  ComponentChoice choice;
  choice.kind = use.kind;
  choice.position = table.position.text();
  const std::optional<std::string> type = type_of(table, use, reading);
  if (!type) return choice;
  choice.name = *type;

  Status status;
  choice.descriptor = reading.registry.find(use.kind, *type, status);
  if (choice.descriptor == nullptr) {
    if (status.ok() || status.code == Code::invalid_input) {
      report_unknown(*type, table, use, reading);
    } else {
      reading.keep_failure(Status::failure(Code::failed, choice.position + ": " + status.text));
    }
    return choice;
  }

  const std::string kind = kind_name(use.kind);
  SchemaOwner owner;
  owner.name = use.owner_names_type ? use.owner : kind + " '" + *type + "' of " + use.owner;
  owner.help = "`bowstring describe " + kind + "/" + *type + "` explains them";
  owner.structural = use.structural;
  const auto count = static_cast<std::size_t>(choice.descriptor->parameter_count);
  Status fault;
  choice.parameters = read_parameters(table, owner, {choice.descriptor->parameters, count}, fault, reading.report);
  reading.keep_failure(fault);
  return choice;
}

ComponentChoice read_component_of(const Node& table, const char* key, Kind kind, const char* default_type,
                                  const std::string& owner, Reading& reading) {
  ComponentUse use;
  use.kind = kind;
  use.owner = owner;
  use.default_type = default_type;
  use.structural = {"type"};

  Node chosen;
  chosen.position = table.position;
  if (const Entry* entry = table.find(key)) {
    if (entry->value.is_table()) return read_component(entry->value, use, reading);
    if (!entry->value.is_text()) {
      const std::string name = kind_name(kind);
      reading.report.error(entry->value.position,
                           "'" + std::string(key) + "' of " + owner + " is " + description(entry->value),
                           "the name of " + with_article(kind) + ", or a table with its 'type'",
                           "write " + std::string(key) + " = \"" + default_type + "\"");
      return {};
    }
    chosen.position = entry->value.position;
    chosen.set({"type", entry->position, entry->value});
  }
  return read_component(chosen, use, reading);
}

}  // namespace bowstring
