#include "core/compare/declared_units.hpp"

#include <iterator>

#include "core/composition/json_words.hpp"
#include "core/composition/losses.hpp"
#include "core/composition/numbers.hpp"
#include "core/composition/resolved_toml.hpp"
#include "core/composition/sequences.hpp"
#include "core/composition/settings.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// Of curves and their ends: what they hold besides is text, plain numbers or plugins.
constexpr ParameterDeclaration curve_quantities[] = {
    {"radius", ParameterType::profile, "mm", "", ""},
    {"span", ParameterType::vector, "mm", "", ""},
    {"move", ParameterType::vector, "mm", "", ""},
    {"turn", ParameterType::vector, "rad", "", ""},
};

const ParameterDeclaration* find(Span<const ParameterDeclaration> schema, const std::string& key) {
  for (const ParameterDeclaration& declaration : schema) {
    if (key == declaration.key) return &declaration;
  }
  return nullptr;
}

/// Where units have alternatives, text with the unit stands in the composition already.
std::string unit_of(const ParameterDeclaration& declaration) {
  const NumberRules rules(declaration);
  return rules.units.size() == 1 ? rules.units.front() : "";
}

std::string number_text(const Json& number) {
  return number.is_number_float() ? decimal(number.get<double>()) : number.dump();
}

Json with_unit(const Json& value, const std::string& unit) {
  if (value.is_number() && !unit.empty()) return number_text(value) + " " + unit;
  Json out = value;
  if (value.is_array()) {
    for (Json& entry : out) entry = with_unit(entry, unit);
  }
  return out;
}

/// The value with text in the place of numbers that have a unit.
Json with_units(const Json& value, const ParameterDeclaration& declaration) {
  const std::string unit = unit_of(declaration);
  Json out = value;
  if (declaration.type == ParameterType::list && value.is_array()) {
    for (Json& item : out) {
      if (!item.is_object()) continue;
      for (auto& [key, inner] : item.items()) {
        const auto count = static_cast<std::size_t>(declaration.item_count);
        if (const auto* own = find({declaration.items, count}, key)) inner = with_units(inner, *own);
      }
    }
    return out;
  }
  if (!value.is_object()) return with_unit(value, unit);
  if (const auto table = out.find("table"); table != out.end() && table->is_array()) {
    for (Json& row : *table) {
      if (!row.is_array() || row.size() != 2) continue;
      row[0] = with_unit(row[0], "mm");
      row[1] = with_unit(row[1], unit);
    }
  }
  if (const auto segments = out.find("segments"); segments != out.end() && segments->is_object()) {
    for (auto& [label, inner] : segments->items()) inner = with_unit(inner, unit);
  }
  return out;
}

}  // namespace

std::string value_text(const Json& value, const ParameterDeclaration* declaration) {
  const Json written = declaration != nullptr ? with_units(value, *declaration) : value;
  if (written.is_string()) return written.get<std::string>();
  return written.is_number() ? number_text(written) : toml_value(written.dump());
}

bool is_default(const Json& value, const ParameterDeclaration* declaration) {
  if (declaration == nullptr || declaration->default_text == nullptr) return false;
  const Json declared = Json::parse(declaration->default_text, nullptr, false);  // a plain TOML value is JSON as well
  return !declared.is_discarded() && declared == value;
}

const ParameterDeclaration* DeclaredUnits::of_plugin(Kind kind, const Json& table, const std::string& key) const {
  const std::string type = text_of(table, "type");
  if (registry_ == nullptr || type.empty()) return nullptr;
  Status ignored;
  const ComponentDescriptor* plugin = registry_->find(kind, type, ignored);
  if (plugin == nullptr) return nullptr;
  return find({plugin->parameters, static_cast<std::size_t>(plugin->parameter_count)}, key);
}

const ParameterDeclaration* DeclaredUnits::of_table(const std::string& table, const std::string& key) {
  if (table == "vessel" || table == "wire" || table == "ends") {
    return find({curve_quantities, std::size(curve_quantities)}, key);
  }
  if (table == "certificate") return find(certificate_schema(), key);
  if (table == "loss") return find(loss_schema(), key);
  return table == "multistart" ? find(multistart_schema(), key) : nullptr;
}

}  // namespace bowstring
