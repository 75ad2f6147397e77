#include "core/composition/settings.hpp"

#include <iterator>
#include <string>

#include "core/composition/keys.hpp"
#include "core/composition/parameters.hpp"

namespace bowstring {
namespace {

ParameterDeclaration threshold(const char* key, const char* unit, const char* default_text, const char* description,
                               double lower, double upper) {
  ParameterDeclaration declaration{key, ParameterType::scalar, unit, default_text, description};
  declaration.lower = lower;
  declaration.upper = upper;
  return declaration;
}

ComponentChoice read_setting(const Node& root, Kind kind, const char* default_type, Reading& reading) {
  const std::string name = kind_name(kind);
  ComponentUse use;
  use.kind = kind;
  use.owner = "[" + name + "]";
  use.default_type = default_type;
  use.structural = {"type"};

  Node by_default;
  by_default.position = root.position;
  const Entry* entry = root.find(name);
  if (entry == nullptr) return read_component(by_default, use, reading);
  const std::string mend = "write [" + name + "] with type = \"" + default_type + "\"";
  if (!check_is_table(entry->value, "'" + name + "'", mend, reading.report)) return {};
  use.owner_names_type = true;
  const std::string type = entry->value.text_at("type");
  use.owner = name + " '" + (type.empty() ? default_type : type) + "'";
  return read_component(entry->value, use, reading);
}

}  // namespace

Span<const ParameterDeclaration> certificate_schema() {
  constexpr double unbounded = 1e308;
  static const ParameterDeclaration schema[] = {
      threshold("stationarity", "N", "1e-6", "largest admissible stationarity", 0.0, unbounded),
      threshold("penetration", "mm", "1e-8", "largest admissible violation of a row", 0.0, unbounded),
      threshold("complementarity", "N mm", "1e-8", "largest admissible complementarity", 0.0, unbounded),
      threshold("multiplier", "N", "-1e-8", "smallest admissible multiplier", -unbounded, 0.0),
      threshold("minimum-stretch", "", "0.2", "an edge at or below this stretch ratio counts as folded", 0.0, 1.0),
      {"require", ParameterType::choice, "", "\"none\"", "what `converged` demands beyond the thresholds", -1e308,
       1e308, false, false, "none|minimum"},
  };
  return {schema, std::size(schema)};
}

int read_dimension(const Node& root, Report& report) {
  const Entry* scene = root.find("scene");
  if (scene == nullptr) {
    report.error(root.position, "the file has no [scene]", "a table with the scene's dimension",
                 "add [scene] with dimension = 2 or dimension = 3");
    return 0;
  }
  const Node& table = scene->value;
  if (!check_is_table(table, "'scene'", "write [scene] with dimension = 2 or dimension = 3", report)) return 0;
  check_keys(table, "[scene]", {"dimension"}, "remove it", report);
  const Entry* dimension = table.find("dimension");
  if (dimension == nullptr) {
    report.error(table.position, "[scene] has no 'dimension'", "2 or 3", "add dimension = 2 or dimension = 3");
    return 0;
  }
  const Node& value = dimension->value;
  if (value.type == Node::Type::integer && (value.integer == 2 || value.integer == 3)) {
    return static_cast<int>(value.integer);
  }
  report.error(value.position, "'dimension' of [scene] is " + description(value), "2 or 3",
               "write dimension = 2 or dimension = 3");
  return 0;
}

std::string read_title(const Node& root, Report& report) {
  const Entry* title = root.find("title");
  if (title == nullptr) return "";
  if (!title->value.is_text()) {
    report.error(title->value.position, "'title' is " + description(title->value), "text", "write it in quotes");
  }
  return title->value.text;
}

ComponentChoice read_enforcement(const Node& root, Reading& reading) {
  return read_setting(root, Kind::enforcement, "kkt", reading);
}

ComponentChoice read_solver(const Node& root, Reading& reading) {
  return read_setting(root, Kind::solver, "interior-point", reading);
}

CertificateTable read_certificate(const Node& root, Report& report) {
  Node empty;
  const Entry* entry = root.find("certificate");
  const Node& table = entry != nullptr ? entry->value : empty;
  CertificateTable certificate;
  if (!check_is_table(table, "'certificate'", "write it under [certificate]", report)) return certificate;

  SchemaOwner owner;
  owner.name = "[certificate]";
  owner.help = "remove it";
  Status no_fault;
  const ParameterSet values = read_parameters(table, owner, certificate_schema(), no_fault, report);
  const auto take = [&](const char* key, double& to) {
    if (values.has(key)) to = values.scalar(key);
  };
  take("stationarity", certificate.stationarity);
  take("penetration", certificate.penetration);
  take("complementarity", certificate.complementarity);
  take("multiplier", certificate.multiplier);
  take("minimum-stretch", certificate.minimum_stretch);
  if (values.has("require")) certificate.require = values.text("require");
  return certificate;
}

}  // namespace bowstring
