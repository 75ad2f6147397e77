// What an assembly is made of before it evaluates anything: numbering, tables, rows, patterns, scales, order.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/assembly/assembly.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Local arc-length spacing of a curve's edges around a fraction of its length.
double local_edge_length(const CurveView& view, double arc_fraction) {
  const int edges = view.nodes - 1;
  const double position = arc_fraction * edges - 0.5;
  const int edge = std::clamp(static_cast<int>(std::lround(position)), 0, edges - 1);
  return view.edge_length[edge];
}

}  // namespace

void Assembly::number_unknowns() {
  free_.assign(at(scene_.unknowns), -1);
  blocks_.begin.assign(1, 0);
  for (const auto& curve : scene_.curves) {
    int coordinate = curve->coordinate_begin;
    int unknown = curve->unknown_begin;
    const double length = std::max(curve->arc.empty() ? 0.0 : curve->arc.back(), 1e-300);
    for (const FieldDeclaration& field : curve->declaration.fields) {
      const int numbers = coordinate_count(field.manifold, field.dimension);
      const int tangents = tangent_count(field.manifold, field.dimension);
      for (int i = 0; i < field.count; ++i) {
        FieldEntry entry;
        entry.manifold = field.manifold;
        entry.dimension = field.dimension;
        entry.coordinate = coordinate;
        entry.unknown = unknown;
        entry.arc_fraction = field.station.empty() ? 0.0 : field.station[at(i)] / length;
        const int first_free = free_count_;
        for (int k = 0; k < tangents; ++k) {
          const bool fixed = !field.fixed.empty() && field.fixed[at(i * tangents + k)] != 0;
          if (fixed) continue;
          free_[at(unknown + k)] = free_count_++;
          blocks_.block_of_unknown.push_back(blocks_.blocks());
          const bool bounded = field.manifold == Manifold::real && !field.lower.empty();
          lower_.push_back(bounded ? field.lower[at(i)] : -infinity);
          upper_.push_back(field.manifold == Manifold::real && !field.upper.empty() ? field.upper[at(i)] : infinity);
        }
        if (free_count_ > first_free) {
          entry.block = blocks_.blocks();
          blocks_.begin.push_back(free_count_);
        }
        entries_.push_back(entry);
        coordinate += numbers;
        unknown += tangents;
      }
    }
  }
  summary_.unknowns = free_count_;
  summary_.fixed = scene_.unknowns - free_count_;
  summary_.bounded_unknowns = std::any_of(lower_.begin(), lower_.end(), [](double x) { return std::isfinite(x); }) ||
                              std::any_of(upper_.begin(), upper_.end(), [](double x) { return std::isfinite(x); });
}

void Assembly::make_tables() {
  table_of_.assign(scene_.curves.size() * site_count, -1);
  for (const auto& curve : scene_.curves) {
    for (const SiteDeclaration& site : curve->declaration.sites) {
      table_of_[at(curve->view.index * site_count + static_cast<int>(site.site))] = static_cast<int>(tables_.size());
      tables_.push_back(make_site_table(*curve, site));
      for (const int u : tables_.back().unknown) tables_.back().free_unknown.push_back(u < 0 ? -1 : free_[at(u)]);
    }
  }
  const std::vector<double> reference = scene_.reference_coordinates();
  std::vector<std::vector<double>> reference_y;
  for (SiteTable& table : tables_) {
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_values({reference.data() + curve.coordinate_begin, at(curve.coordinates)}, 0);
    if (!status.ok()) throw std::runtime_error("curve '" + curve.name + "' at State 1: " + status.text);
    reference_y.push_back(table.y);
  }
  for (int e = 0; e < static_cast<int>(scene_.energies.size()); ++e) {
    EnergyUse& use = scene_.energies[at(e)];
    for (const LawUse& law : use.laws) {
      const int index = table_of_[at(use.curve * site_count + static_cast<int>(law.description.site))];
      if (index < 0) continue;  // the kinematics has no such place: the scene has already said so
      SiteTable& table = tables_[at(index)];
      laws_.push_back({e, index, LawAssembly(law, table, reference_y[at(index)])});
      table.read = table.pulls = true;
      if (!law.description.linear || table.declaration->lengths_vary) {
        table.modulus.assign(at(table.count() * packed_size(table.values())), 0.0);
      }
    }
  }
}

ConstraintRows Assembly::make_constraint_rows(const ConstraintUse& use, int first_row) {
  ConstraintRows out;
  out.first_row = first_row;
  out.in_parts = use.rows.in_parts;
  const RowDeclaration& rows = use.rows;
  out.read_begin.assign(1, 0);
  out.jacobian_begin.assign(1, 0);
  out.hessian_begin.assign(1, 0);
  out.unknown_begin.assign(1, 0);
  for (int r = 0; r < rows.rows; ++r) {
    int numbers = 0, unknowns = 0;
    for (int p = rows.place_begin[at(r)]; p < rows.place_begin[at(r) + 1]; ++p) {
      const Place& place = rows.places[at(p)];
      const int index = table_of_[at(place.curve * site_count + static_cast<int>(place.site))];
      if (index < 0 || place.index < 0 || place.index >= tables_[at(index)].count()) {
        throw std::runtime_error("constraint '" + use.label + "': row " + std::to_string(r) +
                                 " reads a place that curve '" + scene_.curves[at(place.curve)]->name +
                                 "' does not have");
      }
      SiteTable& table = tables_[at(index)];
      table.read = true;
      out.reads.push_back(
          {index, place.index, table.values(), table.width(), numbers, unknowns, table.declaration->identity});
      out.identity = out.identity && table.declaration->identity;
      numbers += table.values();
      unknowns += table.width();
      for (int k = 0; k < table.width(); ++k) {
        const int unknown = table.unknown[at(place.index * table.width() + k)];
        out.unknown.push_back(unknown < 0 ? -1 : free_[at(unknown)]);
      }
    }
    out.read_begin.push_back(static_cast<int>(out.reads.size()));
    out.jacobian_begin.push_back(out.jacobian_begin.back() + numbers);
    out.hessian_begin.push_back(out.hessian_begin.back() + packed_size(numbers));
    out.unknown_begin.push_back(static_cast<int>(out.unknown.size()));
  }
  out.reserve_derivatives();
  return out;
}

void Assembly::make_rows() {
  origins_.clear();
  row_lower_.clear();
  row_upper_.clear();
  summary_.row_groups.clear();
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure || table.count() == 0) continue;
    const Curve& curve = *scene_.curves[at(table.curve)];
    const int count = table.count() * table.values();
    const std::string name = curve.name + ".closure";
    const std::string text =
        curve.declaration.closure_name + " of '" + curve.name + "' (" + std::to_string(count) + ")";
    origins_.push_back({table.curve, -1, static_cast<int>(row_lower_.size()), count, name});
    summary_.row_groups.push_back({name, text, static_cast<int>(row_lower_.size()), count, true});
    row_lower_.resize(row_lower_.size() + at(count), 0.0);
    row_upper_.resize(row_lower_.size(), 0.0);
  }
  summary_.equalities = static_cast<int>(row_lower_.size());
  summary_.inequalities = 0;
  constraints_.clear();
  for (int c = 0; c < static_cast<int>(scene_.constraints.size()); ++c) {
    const ConstraintUse& use = scene_.constraints[at(c)];
    const int first = static_cast<int>(row_lower_.size());
    constraints_.push_back(make_constraint_rows(use, first));
    origins_.push_back({-1, c, first, use.rows.rows, use.label});
    summary_.row_groups.push_back({use.label, "constraint '" + use.label + "' (" + std::to_string(use.rows.rows) + ")",
                                   first, use.rows.rows, false});
    for (int r = 0; r < use.rows.rows; ++r) {
      row_lower_.push_back(use.rows.lower[at(r)]);
      row_upper_.push_back(use.rows.upper[at(r)]);
      (use.rows.lower[at(r)] == use.rows.upper[at(r)] ? summary_.equalities : summary_.inequalities) += 1;
    }
  }
  row_.assign(row_lower_.size(), 0.0);
}

void Assembly::make_scales() {
  scale_.assign(at(free_count_), 1.0);
  std::size_t entry = 0;
  for (const auto& curve : scene_.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      for (int i = 0; i < field.count; ++i, ++entry) {
        const FieldEntry& e = entries_[entry];
        if (e.block < 0 || !(is_curved(e.manifold) || e.manifold == Manifold::circle)) continue;
        const double length = local_edge_length(curve->view, e.arc_fraction);
        for (int u = blocks_.begin[at(e.block)]; u < blocks_.begin[at(e.block) + 1]; ++u) scale_[at(u)] = length;
      }
    }
  }
}

void Assembly::make_patterns() {
  hessian_pattern_ = HessianPattern();
  jacobian_pattern_.clear();
  std::vector<int> free_stencil;
  const auto stencil = [&](const SiteTable& table, int place) {
    free_stencil.clear();
    for (int k = 0; k < table.width(); ++k) {
      const int unknown = table.unknown[at(place * table.width() + k)];
      free_stencil.push_back(unknown < 0 ? -1 : free_[at(unknown)]);
    }
  };
  const auto has_second_order = [](const SiteTable& table) {
    return !table.modulus.empty() || (table.read && table.bends());
  };

  for (const SiteTable& table : tables_) {
    for (int i = 0; i < table.count(); ++i) {
      stencil(table, i);
      if (has_second_order(table)) {
        hessian_pattern_.couple(blocks_, free_stencil.data() + table.hessian_first(), table.hessian_width());
      }
      if (table.declaration->site != Site::closure) continue;
      for (int a = 0; a < table.values(); ++a) jacobian_pattern_.add_row(free_stencil.data(), table.width());
    }
  }
  for (const ConstraintRows& rows : constraints_) {
    for (int r = 0; r < rows.rows(); ++r) {
      const int* unknown = rows.unknown.data() + rows.unknown_begin[at(r)];
      const int count = rows.unknown_begin[at(r) + 1] - rows.unknown_begin[at(r)];
      hessian_pattern_.couple(blocks_, unknown, count);
      jacobian_pattern_.add_row(unknown, count);
    }
  }
  hessian_pattern_.finish(blocks_);

  closure_position_.clear();
  closure_runs_.clear();
  closure_in_run_.clear();
  int row = 0;
  for (SiteTable& table : tables_) {
    table.hessian_position.clear();
    table.all_free.clear();
    const bool closure = table.declaration->site == Site::closure;
    for (int i = 0; i < table.count(); ++i) {
      stencil(table, i);
      if (has_second_order(table)) {
        const int first = table.hessian_first(), end = first + table.hessian_width();
        char free = 1;
        for (int a = first; a < end; ++a) {
          for (int b = first; b <= a; ++b) {
            const int ua = free_stencil[at(a)];
            const int ub = free_stencil[at(b)];
            const bool held = ua < 0 || ub < 0;
            if (held) free = 0;
            table.hessian_position.push_back(held ? -1 : hessian_pattern_.position(blocks_, ua, ub));
          }
        }
        table.all_free.push_back(free);
      }
      if (!closure) continue;
      for (int a = 0; a < table.values(); ++a, ++row) {
        const auto first = closure_position_.size();
        for (const int u : free_stencil) {
          closure_position_.push_back(u < 0 ? -1 : jacobian_pattern_.position(row, u));
        }
        note_closure_row(static_cast<int>(&table - tables_.data()), (i * table.values() + a) * table.width(),
                         closure_position_.data() + first);
      }
    }
  }
  for (ConstraintRows& rows : constraints_) rows.locate(blocks_, hessian_pattern_, jacobian_pattern_);
  find_local_rows();
  make_order();
}

/// Whether every place of every site and row depends on the same unknowns as in another assembly, and to the same
/// order.
bool Assembly::reads_like(const Assembly& other) const noexcept {
  const auto same_table = [](const SiteTable& a, const SiteTable& b) {
    return a.curve == b.curve && a.declaration->site == b.declaration->site && a.count() == b.count() &&
           a.values() == b.values() && a.width() == b.width() && a.read == b.read && a.bends() == b.bends() &&
           a.modulus.empty() == b.modulus.empty() && a.hessian_first() == b.hessian_first() &&
           a.hessian_width() == b.hessian_width() && a.free_unknown == b.free_unknown;
  };
  const auto same_read = [](const ConstraintRows::Read& a, const ConstraintRows::Read& b) {
    return a.table == b.table && a.index == b.index && a.values == b.values && a.width == b.width &&
           a.identity == b.identity;
  };
  const auto same_rows = [&](const ConstraintRows& a, const ConstraintRows& b) {
    return a.first_row == b.first_row && a.read_begin == b.read_begin && a.unknown == b.unknown &&
           std::equal(a.reads.begin(), a.reads.end(), b.reads.begin(), b.reads.end(), same_read);
  };
  return blocks_.begin == other.blocks_.begin &&
         std::equal(tables_.begin(), tables_.end(), other.tables_.begin(), other.tables_.end(), same_table) &&
         std::equal(constraints_.begin(), constraints_.end(), other.constraints_.begin(), other.constraints_.end(),
                    same_rows);
}

/// What `make_patterns` would make.
void Assembly::take_patterns(const Assembly& other) {
  hessian_pattern_ = other.hessian_pattern_;
  jacobian_pattern_ = other.jacobian_pattern_;
  closure_position_ = other.closure_position_;
  closure_runs_ = other.closure_runs_;
  closure_in_run_ = other.closure_in_run_;
  order_ = other.order_;
  border_ = other.border_;
  whole_curve_ = other.whole_curve_;
  local_rows_ = other.local_rows_;
  local_unknowns_ = other.local_unknowns_;
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    tables_[t].hessian_position = other.tables_[t].hessian_position;
    tables_[t].all_free = other.tables_[t].all_free;
  }
  for (std::size_t c = 0; c < constraints_.size(); ++c) constraints_[c].take_positions(other.constraints_[c]);
}

void Assembly::note_closure_row(int table, int first, const int* position) {
  const int width = tables_[at(table)].width();
  bool in_order = position[0] >= 0;
  for (int k = 0; k < width; ++k) in_order = in_order && position[k] == position[0] + k;
  closure_in_run_.push_back(in_order ? 1 : 0);
  if (!in_order) return;
  if (!closure_runs_.empty()) {
    Run& last = closure_runs_.back();
    if (last.table == table && last.first + last.count == first && last.position + last.count == position[0]) {
      last.count += width;
      return;
    }
  }
  closure_runs_.push_back({table, first, position[0], width});
}

void Assembly::find_local_rows() {
  std::vector<int> places(at(free_count_), 0);  // closure places, and constraints' equality rows, that read an unknown
  whole_curve_.assign(at(free_count_), 0);
  local_rows_.clear();
  local_unknowns_.clear();
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure) continue;
    std::vector<int> of_table(at(free_count_), 0);
    for (const int u : table.free_unknown) {
      if (u >= 0) ++of_table[at(u)], ++places[at(u)];
    }
    constexpr int few = 2;  // edges that meet at a node
    for (int u = 0; u < free_count_; ++u)
      whole_curve_[at(u)] |= of_table[at(u)] > few && of_table[at(u)] == table.count();
  }
  for (const ConstraintRows& rows : constraints_) {
    for (int r = 0; r < rows.rows(); ++r) {
      if (row_lower_[at(rows.first_row + r)] != row_upper_[at(rows.first_row + r)]) continue;
      for (int k = rows.unknown_begin[at(r)]; k < rows.unknown_begin[at(r) + 1]; ++k) {
        if (rows.unknown[at(k)] >= 0) ++places[at(rows.unknown[at(k)])];
      }
    }
  }
  std::vector<char> is_position(at(free_count_), 0);
  for (const FieldEntry& entry : entries_) {
    if (entry.block < 0 || entry.manifold != Manifold::vector) continue;
    for (int u = blocks_.begin[at(entry.block)]; u < blocks_.begin[at(entry.block) + 1]; ++u) is_position[at(u)] = 1;
  }
  int row = 0;
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure) continue;
    for (int i = 0; i < table.count(); ++i, row += table.values()) {
      LocalRows local{row, table.values(), static_cast<int>(local_unknowns_.size()), 0};
      for (int k = 0; k < table.width(); ++k) {
        const int u = table.free_unknown[at(i * table.width() + k)];
        if (u < 0 || places[at(u)] != 1 || is_position[at(u)] != 0) continue;
        local_unknowns_.push_back(u);
        ++local.locals;
      }
      if (local.locals > 0) local_rows_.push_back(local);
    }
  }
}

std::vector<double> Assembly::places_along() const {
  std::vector<double> place(at(free_count_), 0.0);
  // Of a curve whose rows search places along another one: (its own arc fraction, that of the other curve).
  std::vector<std::vector<std::pair<double, double>>> seen(scene_.curves.size());
  const auto node_fraction = [&](const ConstraintRows::Read& read) {
    const CurveView& view = curve_of(tables_[at(read.table)]).view;
    return static_cast<double>(read.index) / (view.nodes - 1);
  };
  for (const ConstraintRows& rows : constraints_) {
    for (int r = 0; r < rows.rows(); ++r) {
      const int first = rows.read_begin[at(r)], end = rows.read_begin[at(r) + 1];
      if (first == end) continue;
      const int own = tables_[at(rows.reads[at(first)].table)].curve;
      double mine = 0.0, other = 0.0;
      int mine_count = 0, other_count = 0;
      for (int k = first; k < end; ++k) {
        const bool is_own = tables_[at(rows.reads[at(k)].table)].curve == own;
        (is_own ? mine : other) += node_fraction(rows.reads[at(k)]);
        ++(is_own ? mine_count : other_count);
      }
      if (other_count > 0) seen[at(own)].emplace_back(mine / mine_count, other / other_count);
    }
  }
  for (auto& pairs : seen) std::sort(pairs.begin(), pairs.end());
  std::size_t index = 0;
  for (const auto& curve : scene_.curves) {
    const auto& pairs = seen[at(curve->view.index)];
    for (const FieldDeclaration& field : curve->declaration.fields) {
      for (int i = 0; i < field.count; ++i, ++index) {
        const FieldEntry& entry = entries_[index];
        if (entry.block < 0) continue;
        double along = entry.arc_fraction;
        if (!pairs.empty()) {
          const auto next = std::lower_bound(pairs.begin(), pairs.end(), std::pair<double, double>{along, -infinity});
          if (next == pairs.begin()) {
            along += next->second - next->first;
          } else if (next == pairs.end()) {
            along += pairs.back().second - pairs.back().first;
          } else {
            const auto before = next - 1;
            const double width = next->first - before->first;
            const double t = width > 0.0 ? (along - before->first) / width : 0.0;
            along = before->second + t * (next->second - before->second);
          }
        }
        for (int u = blocks_.begin[at(entry.block)]; u < blocks_.begin[at(entry.block) + 1]; ++u) place[at(u)] = along;
      }
    }
  }
  return place;
}

void Assembly::make_order() {
  const int n = free_count_;
  const int m = rows();
  std::vector<double> key = places_along();
  key.resize(at(n + m), -infinity);
  border_ = 0;
  for (int u = 0; u < n; ++u) {
    if (whole_curve_[at(u)] == 0) continue;
    key[at(u)] = infinity;
    ++border_;
  }
  const SparsityPattern pattern = jacobian_pattern_.view();
  for (int r = 0; r < m; ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      const double place = key[at(pattern.inner[at(k)])];
      if (place < infinity) key[at(n + r)] = std::max(key[at(n + r)], place);
    }
  }
  order_.resize(at(n + m));
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return key[at(a)] < key[at(b)]; });
}

}  // namespace bowstring
