#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <nlohmann/json.hpp>

#include "apps/shell.hpp"
#include "core/composition/nearest.hpp"

namespace bowstring::apps {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> all_kinds() {
  std::vector<std::string> names;
  for (int k = 0; k < kind_count; ++k) names.emplace_back(kind_name(static_cast<Kind>(k)));
  return names;
}

std::optional<Kind> parse_kind(const std::string& name) {
  const std::vector<std::string> names = all_kinds();
  for (int k = 0; k < kind_count; ++k) {
    if (names[static_cast<std::size_t>(k)] == name) return static_cast<Kind>(k);
  }
  std::string text = "unknown kind '" + name + "'; expected one of:";
  for (const std::string& known : names) text += " " + known;
  const auto nearest = nearest_names(name, names);
  if (!nearest.empty()) text += "; did you mean '" + nearest.front() + "'?";
  complain(text);
  return std::nullopt;
}

const char* type_name(ParameterType type) {
  switch (type) {
    case ParameterType::scalar:
      return "scalar";
    case ParameterType::profile:
      return "profile";
    case ParameterType::vector:
      return "vector";
    case ParameterType::path:
      return "path";
    case ParameterType::choice:
      return "choice";
    case ParameterType::integer:
      return "integer";
    case ParameterType::flag:
      return "flag";
    case ParameterType::text:
      return "text";
    case ParameterType::names:
      return "names";
    case ParameterType::list:
      break;
  }
  return "list";
}

bool bounded(double bound) { return std::fabs(bound) < 1e300; }

Json schema(const ParameterDeclaration* parameters, int count) {
  Json out = Json::array();
  for (int i = 0; i < count; ++i) {
    const ParameterDeclaration& p = parameters[i];
    Json entry = {{"key", p.key}, {"type", type_name(p.type)}, {"unit", p.unit}};
    entry["default"] = p.default_text == nullptr || *p.default_text == '\0' ? Json(nullptr) : Json(p.default_text);
    entry["required"] = p.default_text == nullptr;
    entry["lower"] = bounded(p.lower) ? Json(p.lower) : Json(nullptr);
    entry["lower_exclusive"] = p.lower_exclusive;
    entry["upper"] = bounded(p.upper) ? Json(p.upper) : Json(nullptr);
    entry["choices"] = p.choices;
    entry["differentiable"] = p.differentiable;
    entry["description"] = p.description;
    if (p.item_count > 0) entry["items"] = schema(p.items, p.item_count);
    out.push_back(std::move(entry));
  }
  return out;
}

/// "N/mm^2 or N/mm"; an alternative without a unit is a bare number.
std::string unit_text(const std::string& alternatives) {
  std::string out;
  for (std::size_t begin = 0; begin <= alternatives.size();) {
    const std::size_t end = std::min(alternatives.find('|', begin), alternatives.size());
    const std::string unit = alternatives.substr(begin, end - begin);
    out += (out.empty() ? "" : " or ") + (unit.empty() ? "a bare number" : unit);
    begin = end + 1;
  }
  return out;
}

void print_schema(const ParameterDeclaration* parameters, int count, int indent) {
  for (int i = 0; i < count; ++i) {
    const ParameterDeclaration& p = parameters[i];
    std::string facts = type_name(p.type);
    if (*p.unit != '\0') facts += ", " + unit_text(p.unit);
    if (*p.choices != '\0') facts += std::string(", one of ") + p.choices;
    if (bounded(p.lower)) facts += (p.lower_exclusive ? ", > " : ", >= ") + number(p.lower);
    if (bounded(p.upper)) facts += ", <= " + number(p.upper);
    if (p.default_text == nullptr) {
      facts += ", required";
    } else {
      facts += *p.default_text == '\0' ? ", optional" : std::string(", default ") + p.default_text;
    }
    if (p.differentiable) facts += ", differentiable";
    std::printf("%*s%-22s %s\n%*s%s\n", indent, "", p.key, facts.c_str(), indent + 4, "", p.description);
    if (p.item_count > 0) print_schema(p.items, p.item_count, indent + 4);
  }
}

}  // namespace

int list_plugins(const CommonOptions& common, const std::string& kind, bool json) {
  PluginHost host = make_host(common, "");
  std::vector<Kind> kinds;
  if (kind.empty()) {
    for (int k = 0; k < kind_count; ++k) kinds.push_back(static_cast<Kind>(k));
  } else {
    const std::optional<Kind> parsed = parse_kind(kind);
    if (!parsed) return exit_wrong_input;
    kinds.push_back(*parsed);
  }
  for (const std::string& problem : host.problems()) std::fprintf(stderr, "warning: %s\n", problem.c_str());
  Json out = Json::array();
  for (const Kind k : kinds) {
    for (const std::string& name : host.names(k)) {
      const std::string description = host.description(k, name);
      if (json) {
        out.push_back({{"kind", kind_name(k)},
                       {"name", name},
                       {"description", description},
                       {"file", host.origin(k, name).file}});
      } else {
        std::printf("%-12s %-20s %s\n", kind_name(k), name.c_str(), description.c_str());
      }
    }
  }
  if (json) std::printf("%s\n", out.dump(1).c_str());
  return exit_converged;
}

int describe(const CommonOptions& common, const std::string& what, bool json) {
  const std::size_t slash = what.find('/');
  if (slash == std::string::npos) {
    complain("'" + what + "': expected KIND/NAME, for instance energy/wire-bending");
    return exit_wrong_input;
  }
  const std::optional<Kind> kind = parse_kind(what.substr(0, slash));
  if (!kind) return exit_wrong_input;
  PluginHost host = make_host(common, "");
  Status status;
  const ComponentDescriptor* component = host.find(*kind, what.substr(slash + 1), status);
  if (component == nullptr) {
    complain(status.text);
    return status.code == Code::invalid_input ? exit_wrong_input : exit_plugin_failed;
  }
  if (json) {
    const Json out = {{"kind", kind_name(*kind)},
                      {"name", component->name},
                      {"description", component->description},
                      {"parameters", schema(component->parameters, component->parameter_count)}};
    std::printf("%s\n", out.dump(1).c_str());
    return exit_converged;
  }
  std::printf("%s/%s: %s\n", kind_name(*kind), component->name, component->description);
  print_schema(component->parameters, component->parameter_count, 2);
  return exit_converged;
}

}  // namespace bowstring::apps
