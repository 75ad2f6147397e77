#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/interfaces/component.hpp"
#include "core/interfaces/registry.hpp"

namespace bowstring {

/// A value of a resolved composition as an override takes it. `declaration`: of the parameter, which says the unit of
/// bare numbers; null: they stand as they are.
std::string value_text(const nlohmann::ordered_json& value, const ParameterDeclaration* declaration);

/// Whether a value is a parameter's declared default; false where nothing is declared.
bool is_default(const nlohmann::ordered_json& value, const ParameterDeclaration* declaration);

/// Finds the declarations of what a composition holds.
class DeclaredUnits {
 public:
  /// `registry` null: those of plugins are not known.
  explicit DeclaredUnits(Registry* registry) : registry_(registry) {}

  /// A parameter of the plugin that `table` of this kind chooses by its `type`; null where it is not known.
  const ParameterDeclaration* of_plugin(Kind kind, const nlohmann::ordered_json& table, const std::string& key) const;

  /// What belongs to no plugin: a key of a curve, an end, [certificate], [multistart]. Null: a plain number, or text.
  static const ParameterDeclaration* of_table(const std::string& table, const std::string& key);

 private:
  Registry* registry_;
};

}  // namespace bowstring
