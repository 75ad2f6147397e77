#include "core/check/unknowns.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

const char* component_name(const FieldEntry& entry, int component) {
  static const char* const axes[] = {"x", "y", "z"};
  static const char* const body[] = {"turn about its tangent", "turn about its second axis",
                                     "turn about its third axis"};
  switch (entry.manifold) {
    case Manifold::vector:
      return entry.dimension <= 3 ? axes[component] : "";
    case Manifold::direction:
      return body[component + 1];
    case Manifold::rotation:
      return body[component];
    default:
      return "";
  }
}

/// Smallest nodal radius of the scene's vessels; infinity where none is known.
double smallest_radius(const Scene& scene) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& curve : scene.curves) {
    if (curve->view.kind != CurveKind::vessel) continue;
    for (const double radius : curve->radius) out = std::min(out, radius);
  }
  return out;
}

double edge_length_near(const CurveView& view, double arc_fraction) {
  const int edges = view.nodes - 1;
  const int edge = std::clamp(static_cast<int>(arc_fraction * edges), 0, edges - 1);
  return view.edge_length[edge];
}

}  // namespace

std::vector<FieldGroup> field_groups(const Assembly& assembly) {
  std::vector<FieldGroup> out;
  int entry = 0, free = 0;
  for (const auto& curve : assembly.scene().curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      FieldGroup group{curve->view.index, &field, entry, entry + field.count, free, free};
      for (; entry < group.entry_end; ++entry) {
        const FieldEntry& e = assembly.entries()[at(entry)];
        if (e.block >= 0) group.end += assembly.blocks().size(e.block);
      }
      free = group.end;
      out.push_back(group);
    }
  }
  return out;
}

std::string group_name(const Assembly& assembly, const FieldGroup& group) {
  return group.field->name + " of '" + assembly.scene().curves[at(group.curve)]->name + "'";
}

std::string unknown_name(const Assembly& assembly, int free_unknown) {
  for (const FieldGroup& group : field_groups(assembly)) {
    if (free_unknown < group.begin || free_unknown >= group.end) continue;
    for (int i = group.entry_begin; i < group.entry_end; ++i) {
      const FieldEntry& entry = assembly.entries()[at(i)];
      for (int k = 0; k < tangent_count(entry.manifold, entry.dimension); ++k) {
        if (assembly.free_of_unknown()[at(entry.unknown + k)] != free_unknown) continue;
        const std::string component = component_name(entry, k);
        return group.field->name + " " + std::to_string(i - group.entry_begin) + " of '" +
               assembly.scene().curves[at(group.curve)]->name + "'" + (component.empty() ? "" : ", " + component);
      }
    }
  }
  return "unknown " + std::to_string(free_unknown);
}

std::string row_name(const Assembly& assembly, int row) {
  const Scene& scene = assembly.scene();
  for (const RowOrigin& origin : assembly.row_origins()) {
    const int local = row - origin.first;
    if (local < 0 || local >= origin.count) continue;
    const std::string out = "row " + std::to_string(local);
    if (origin.constraint < 0) return out;
    const RowDeclaration& rows = scene.constraints[at(origin.constraint)].rows;
    if (rows.place_begin[at(local)] == rows.place_begin[at(local) + 1]) return out;
    const Place& place = rows.places[at(rows.place_begin[at(local)])];
    return out + " (" + site_name(place.site) + " " + std::to_string(place.index) + " of '" +
           scene.curves[at(place.curve)]->name + "')";
  }
  return "row " + std::to_string(row);
}

std::string term_name(const Scene& scene, int term) {
  const EnergyUse& use = scene.energies[at(term)];
  return "energy '" + use.label + "' on '" + scene.curves[at(use.curve)]->name + "'";
}

std::string origin_name(const Scene& scene, const RowOrigin& origin) {
  if (origin.constraint >= 0) return "constraint '" + origin.name + "'";
  const Curve& curve = *scene.curves[at(origin.curve)];
  return curve.declaration.closure_name + " of '" + curve.name + "'";
}

std::vector<double> natural_steps(const Assembly& assembly) {
  const double radius = smallest_radius(assembly.scene());
  std::vector<double> out(at(assembly.unknowns()), 1.0);
  for (const FieldGroup& group : field_groups(assembly)) {
    const CurveView& view = assembly.scene().curves[at(group.curve)]->view;
    for (int i = group.entry_begin; i < group.entry_end; ++i) {
      const FieldEntry& entry = assembly.entries()[at(i)];
      if (entry.block < 0 || (entry.manifold != Manifold::vector && entry.manifold != Manifold::real)) continue;
      const bool whole = entry.manifold == Manifold::real && group.field->count == 1;
      const double step =
          whole ? std::max(view.start_length, 1e-3) : std::min(edge_length_near(view, entry.arc_fraction), radius);
      for (int k = 0; k < assembly.blocks().size(entry.block); ++k) {
        out[at(assembly.blocks().begin[at(entry.block)] + k)] = step;
      }
    }
  }
  return out;
}

std::vector<double> free_part(const Assembly& assembly, const std::vector<double>& all) {
  std::vector<double> out(at(assembly.unknowns()));
  for (std::size_t u = 0; u < all.size(); ++u) {
    if (assembly.free_of_unknown()[u] >= 0) out[at(assembly.free_of_unknown()[u])] = all[u];
  }
  return out;
}

SymmetricProduct symmetric_product(const SparsityPattern& pattern, const std::vector<double>& values,
                                   const std::vector<double>& direction) {
  const int n = static_cast<int>(direction.size());
  SymmetricProduct out{std::vector<double>(at(n)), std::vector<double>(at(n))};
  const auto add = [&](int i, double product) {
    out.value[at(i)] += product;
    out.size[at(i)] += product * product;
  };
  for (int j = 0; j < n; ++j) {
    for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
      const int i = pattern.inner[at(k)];
      add(i, values[at(k)] * direction[at(j)]);
      if (i != j) add(j, values[at(k)] * direction[at(i)]);
    }
  }
  for (double& size : out.size) size = std::sqrt(size);
  return out;
}

SymmetricProduct row_product(const SparsityPattern& pattern, const std::vector<double>& values,
                             const std::vector<double>& direction) {
  const int rows = static_cast<int>(pattern.begin.size()) - 1;
  SymmetricProduct out{std::vector<double>(at(rows)), std::vector<double>(at(rows))};
  for (int r = 0; r < rows; ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      const double product = values[at(k)] * direction[at(pattern.inner[at(k)])];
      out.value[at(r)] += product;
      out.size[at(r)] += product * product;
    }
    out.size[at(r)] = std::sqrt(out.size[at(r)]);
  }
  return out;
}

std::vector<double> transposed_product(const SparsityPattern& pattern, const std::vector<double>& values,
                                       const RowOrigin& origin, const std::vector<double>& multipliers, int unknowns) {
  std::vector<double> out(at(unknowns), 0.0);
  for (int r = origin.first; r < origin.first + origin.count; ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      out[at(pattern.inner[at(k)])] += values[at(k)] * multipliers[at(r)];
    }
  }
  return out;
}

}  // namespace bowstring::checking
