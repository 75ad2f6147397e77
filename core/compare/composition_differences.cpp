#include "core/compare/composition_differences.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/compare/declared_units.hpp"
#include "core/composition/json_words.hpp"
#include "core/composition/resolved_toml.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// The parameter that is known under a key of a table.
using Declarations = std::function<const ParameterDeclaration*(const Json& table, const std::string& key)>;

/// A profile's form, "" of what is none: its keys belong together.
std::string form_of(const Json& value) {
  for (const char* form : {"table", "segments", "column"}) {
    if (value.is_object() && value.contains(form)) return form;
  }
  return "";
}

/// The composition of each state: the first, and what the steps after it change.
struct NamedState {
  std::string step;  ///< "" without steps
  Json composition;
};

std::vector<NamedState> states_of(const Json& root) {
  std::vector<NamedState> out;
  Json composition = root;
  composition.erase("step");
  const Json* steps = find_key(root, "step");
  if (steps == nullptr || steps->empty()) return {{"", std::move(composition)}};
  for (const Json& step : *steps) {
    for (const auto& [key, value] : step.items()) {
      if (key != "name") composition[key] = value;
    }
    if (!step.contains("rest")) composition.erase("rest");
    out.push_back({text_of(step, "name"), composition});
  }
  return out;
}

/// Compares the compositions of two states.
class Differ {
 public:
  explicit Differ(const DeclaredUnits& units) : units_(units) {}

  std::vector<CompositionDifference> run(const Json& a, const Json& b) {
    for_each_key(a, b, [&](const std::string& key, const Json* in_a, const Json* in_b) {
      const bool tables = in_a != nullptr && in_b != nullptr && in_a->is_object() && in_b->is_object();
      if (key == "vessel" || key == "wire" || key == "energy" || key == "constraint" || key == "loss") {
        static const Json none = Json::array();
        compare_entries(key, in_a != nullptr ? *in_a : none, in_b != nullptr ? *in_b : none);
      } else if (tables) {
        compare_tables(key, *in_a, *in_b, of_root_table(key));
      } else {
        compare_values(key, in_a, in_b, nullptr, "");
      }
    });
    return std::move(out_);
  }

 private:
  template <class Visit>
  static void for_each_key(const Json& a, const Json& b, Visit visit) {
    for (const auto& [key, value] : a.items()) visit(key, &value, find_key(b, key));
    for (const auto& [key, value] : b.items()) {
      if (!a.contains(key)) visit(key, nullptr, &value);
    }
  }

  Declarations of_component(Kind kind) const {
    return [this, kind](const Json& table, const std::string& key) { return units_.of_plugin(kind, table, key); };
  }

  Declarations of_root_table(const std::string& name) const {
    if (name == "enforcement") return of_component(Kind::enforcement);
    if (name == "solver") return of_component(Kind::solver);
    return [name](const Json&, const std::string& key) { return DeclaredUnits::of_table(name, key); };
  }

  Declarations of_entry(const std::string& list) const {
    if (list == "energy") return of_component(Kind::energy);
    if (list == "constraint") return of_component(Kind::constraint);
    return of_root_table(list);
  }

  void add(const std::string& path, std::optional<std::string> a, std::optional<std::string> b,
           const std::string& because_of) {
    out_.push_back({path, std::move(a), std::move(b), because_of, path != "title"});
  }

  void compare_values(const std::string& path, const Json* a, const Json* b, const ParameterDeclaration* declaration,
                      const std::string& because_of) {
    compare_values(path, a, b, declaration, declaration, because_of);
  }

  void compare_values(const std::string& path, const Json* a, const Json* b, const ParameterDeclaration* of_a,
                      const ParameterDeclaration* of_b, const std::string& because_of) {
    if (a != nullptr && b != nullptr && *a == *b) return;
    const auto text = [](const Json* value, const ParameterDeclaration* declaration) {
      return value != nullptr ? std::optional<std::string>(value_text(*value, declaration)) : std::nullopt;
    };
    add(path, text(a, of_a), text(b, of_b), because_of);
  }

  /// The entries of a list of tables, by their names.
  void compare_entries(const std::string& list, const Json& a, const Json& b) {
    if (!a.is_array() || !b.is_array()) return compare_values(list, &a, &b, nullptr, "");
    std::vector<const Json*> partner_of_a(a.size(), nullptr);
    std::vector<bool> taken(b.size(), false);
    const auto pair_up = [&](const auto& fits) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size() && partner_of_a[i] == nullptr; ++j) {
          if (taken[j] || !fits(a[i], b[j])) continue;
          partner_of_a[i] = &b[j];
          taken[j] = true;
        }
      }
    };
    pair_up([](const Json& one, const Json& other) { return text_of(one, "name") == text_of(other, "name"); });
    const auto unnamed = [](const Json& entry) {
      return entry.contains("type") && text_of(entry, "name") == text_of(entry, "type");
    };
    pair_up([&](const Json& one, const Json& other) {
      return unnamed(one) && unnamed(other) && one.value("on", Json()) == other.value("on", Json());
    });
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::string path = list + "." + path_step(text_of(a[i], "name"));
      if (partner_of_a[i] == nullptr) {
        compare_values(path, &a[i], nullptr, nullptr, "");
      } else {
        compare_entry(list, path, a[i], *partner_of_a[i], unnamed(a[i]) && unnamed(*partner_of_a[i]));
      }
    }
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (!taken[j]) compare_values(list + "." + path_step(text_of(b[j], "name")), nullptr, &b[j], nullptr, "");
    }
  }

  void compare_entry(const std::string& list, const std::string& path, Json a, Json b, bool unnamed) {
    if (unnamed) {  // the name is the type's
      a.erase("name");
      b.erase("name");
    }
    compare_tables(path, a, b, of_entry(list));
  }

  void compare_tables(const std::string& path, const Json& a, const Json& b, const Declarations& declared) {
    const Json *type_a = find_key(a, "type"), *type_b = find_key(b, "type");
    const bool other_type = type_a != nullptr && type_b != nullptr && *type_a != *type_b;
    if (other_type) compare_values(path + ".type", type_a, type_b, nullptr, "");
    for_each_key(a, b, [&](const std::string& key, const Json* in_a, const Json* in_b) {
      const bool both = in_a != nullptr && in_b != nullptr;
      if ((both && *in_a == *in_b) || (key == "type" && other_type)) return;
      const std::string inner = path + "." + path_step(key);
      const bool brought_along =
          other_type && (!both || (is_default(*in_a, declared(a, key)) && is_default(*in_b, declared(b, key))));
      const std::string because_of = brought_along ? path + ".type" : "";
      if (key == "geometry" && both) {
        compare_tables(inner, *in_a, *in_b, of_component(Kind::geometry));
      } else if (key == "kinematics" && both) {
        compare_tables(inner, *in_a, *in_b, of_component(Kind::kinematics));
      } else if (key == "transport" && both && in_a->is_object() && in_b->is_object()) {
        compare_tables(inner, *in_a, *in_b, of_component(Kind::transport));
      } else if (key == "ground-cost" && both && in_a->is_object() && in_b->is_object()) {
        compare_tables(inner, *in_a, *in_b, of_component(Kind::ground_cost));
      } else if (key == "ends" && both && in_a->is_array() && in_b->is_array() && in_a->size() == 2 &&
                 in_b->size() == 2) {
        compare_ends(inner + ".first", in_a->front(), in_b->front());
        compare_ends(inner + ".last", in_a->back(), in_b->back());
      } else if (both && form_of(*in_a) == "segments" && form_of(*in_b) == "segments") {
        compare_segments(inner + ".segments", (*in_a)["segments"], (*in_b)["segments"], declared(a, key));
      } else {
        compare_values(inner, in_a, in_b, declared(a, key), declared(b, key), because_of);
      }
    });
  }

  void compare_segments(const std::string& path, const Json& a, const Json& b, const ParameterDeclaration* declared) {
    for_each_key(a, b, [&](const std::string& label, const Json* in_a, const Json* in_b) {
      compare_values(path + "." + path_step(label), in_a, in_b, declared, "");
    });
  }

  /// A type's name, or a table; with its type, or with what is held axis by axis.
  void compare_ends(const std::string& path, const Json& a, const Json& b) {
    if (a == b) return;
    const auto table = [](const Json& end) { return end.is_string() ? Json{{"type", end}} : end; };
    const Json one = table(a), other = table(b);
    const bool alike = one.is_object() && other.is_object() && one.contains("type") == other.contains("type");
    if (!alike || (a.is_string() && b.is_string())) return compare_values(path, &a, &b, nullptr, "");
    compare_tables(path, one, other,
                   [](const Json&, const std::string& key) { return DeclaredUnits::of_table("ends", key); });
  }

  const DeclaredUnits& units_;
  std::vector<CompositionDifference> out_;
};

bool same(const CompositionDifference& one, const CompositionDifference& other) {
  return one.path == other.path && one.a == other.a && one.b == other.b;
}

std::string names_of(const std::vector<NamedState>& states) {
  std::string out;
  for (const NamedState& state : states) out += (out.empty() ? "" : ", ") + state.step;
  return out;
}

}  // namespace

std::vector<CompositionDifference> composition_differences(const std::string& a, const std::string& b,
                                                           Registry* registry) {
  const DeclaredUnits units(registry);
  const std::vector<NamedState> first = states_of(Json::parse(a)), second = states_of(Json::parse(b));
  std::vector<CompositionDifference> before = Differ(units).run(first.front().composition, second.front().composition);
  std::vector<CompositionDifference> out = before;
  if (first.front().step.empty() != second.front().step.empty()) {
    const auto steps = [](const std::vector<NamedState>& states) {
      const std::string names = names_of(states);
      return names.empty() ? std::nullopt : std::optional<std::string>(names);
    };
    out.push_back({"step", steps(first), steps(second), ""});
    return out;
  }
  for (std::size_t k = 0; k < std::max(first.size(), second.size()); ++k) {
    if (k >= first.size()) {
      out.push_back({"step." + path_step(second[k].step), std::nullopt, second[k].step, ""});
      continue;
    }
    const std::string step = "step." + path_step(first[k].step);
    if (k >= second.size()) {
      out.push_back({step, first[k].step, std::nullopt, ""});
      continue;
    }
    if (first[k].step != second[k].step) out.push_back({step + ".name", first[k].step, second[k].step, ""});
    if (k == 0) continue;
    std::vector<CompositionDifference> here = Differ(units).run(first[k].composition, second[k].composition);
    for (const CompositionDifference& difference : here) {
      const bool told =
          std::any_of(before.begin(), before.end(), [&](const auto& one) { return same(one, difference); });
      if (told) continue;
      CompositionDifference of_step = difference;
      of_step.path = step + "." + path_step(difference.path);
      if (!of_step.because_of.empty()) of_step.because_of = step + "." + path_step(difference.because_of);
      out.push_back(std::move(of_step));
    }
    before = std::move(here);
  }
  return out;
}

}  // namespace bowstring
