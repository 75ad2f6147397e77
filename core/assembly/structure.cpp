// What an assembly is made of before it evaluates anything: numbering, tables, rows, patterns, scales, order.

#include <algorithm>
#include <cmath>
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
      tables_.back().find_blocks(blocks_.block_of_unknown);
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

void Assembly::number_rows() {
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure || table.count() == 0) continue;
    const Curve& curve = *scene_.curves[at(table.curve)];
    const int count = table.count() * table.values();
    const std::string name = curve.name + ".closure";
    const std::string text =
        curve.declaration.closure_name + " of '" + curve.name + "' (" + std::to_string(count) + ")";
    origins_.push_back({table.curve, -1, rows(), count, name});
    summary_.row_groups.push_back({name, text, rows(), count, true});
    row_lower_.resize(row_lower_.size() + at(count), 0.0);
    row_upper_.resize(row_lower_.size(), 0.0);
  }
  closure_rows_ = rows();
  constraints_.resize(scene_.constraints.size());
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const ConstraintUse& use = scene_.constraints[c];
    constraints_[c].first_row = rows();
    origins_.push_back({-1, static_cast<int>(c), rows(), use.rows.rows, use.label});
    summary_.row_groups.push_back({use.label, "constraint '" + use.label + "' (" + std::to_string(use.rows.rows) + ")",
                                   rows(), use.rows.rows, false});
    row_lower_.resize(row_lower_.size() + at(use.rows.rows), 0.0);
    row_upper_.resize(row_lower_.size(), 0.0);
  }
  row_.assign(row_lower_.size(), 0.0);
}

bool Assembly::read_rows() {
  const auto count_read = [&] {
    return std::count_if(tables_.begin(), tables_.end(), [](const SiteTable& table) { return table.read; });
  };
  const auto before = count_read();
  summary_.equalities = closure_rows_;
  summary_.inequalities = 0;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const ConstraintUse& use = scene_.constraints[c];
    ConstraintRows& rows = constraints_[c];
    const int flawed = rows.bind(use.rows, table_of_, tables_);
    if (flawed >= 0) throw std::runtime_error(missing_place(use, flawed));
    const int inequalities_before = summary_.inequalities;
    for (int r = 0; r < use.rows.rows; ++r) {
      row_lower_[at(rows.first_row + r)] = use.rows.lower[at(r)];
      row_upper_[at(rows.first_row + r)] = use.rows.upper[at(r)];
      (use.rows.lower[at(r)] == use.rows.upper[at(r)] ? summary_.equalities : summary_.inequalities) += 1;
    }
    RowGroup& group = summary_.row_groups[summary_.row_groups.size() - constraints_.size() + c];
    group.inequalities = summary_.inequalities - inequalities_before;
  }
  return count_read() != before;
}

std::string Assembly::missing_place(const ConstraintUse& use, int row) const {
  for (int p = use.rows.place_begin[at(row)]; p < use.rows.place_begin[at(row) + 1]; ++p) {
    const Place& place = use.rows.places[at(p)];
    const SiteTable* table = find_table(place.curve, place.site);
    if (table != nullptr && place.index >= 0 && place.index < table->count()) continue;
    return "constraint '" + use.label + "': row " + std::to_string(row) + " reads a place that curve '" +
           scene_.curves[at(place.curve)]->name + "' does not have";
  }
  return {};
}

bool Assembly::rows_stay() const noexcept {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const RowDeclaration& rows = scene_.constraints[c].rows;
    const int first = constraints_[c].first_row;
    if (rows.in_parts != constraints_[c].in_parts || !constraints_[c].reads_as(rows, table_of_) ||
        !std::equal(rows.lower.begin(), rows.lower.end(), row_lower_.begin() + first) ||
        !std::equal(rows.upper.begin(), rows.upper.end(), row_upper_.begin() + first)) {
      return false;
    }
  }
  return true;
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

void Assembly::make_lasting_patterns() {
  const auto has_second_order = [](const SiteTable& table) {
    return !table.modulus.empty() || (table.read && table.bends());
  };
  lasting_pattern_ = HessianPattern();
  jacobian_pattern_.clear();
  for (const SiteTable& table : tables_) {
    for (int i = 0; i < table.count(); ++i) {
      const int* stencil = table.free_unknown.data() + i * table.width();
      if (has_second_order(table)) {
        lasting_pattern_.couple(blocks_, stencil + table.hessian_first(), table.hessian_width());
      }
      if (table.declaration->site != Site::closure) continue;
      for (int a = 0; a < table.values(); ++a) jacobian_pattern_.add_row(stencil, table.width());
    }
  }
  lasting_pattern_.finish(blocks_);

  closure_position_.clear();
  closure_runs_.clear();
  closure_in_run_.clear();
  int row = 0;
  for (SiteTable& table : tables_) {
    table.lasting_position.clear();
    table.all_free.clear();
    const bool closure = table.declaration->site == Site::closure;
    for (int i = 0; i < table.count(); ++i) {
      const int* stencil = table.free_unknown.data() + i * table.width();
      if (has_second_order(table)) {
        const int first = table.hessian_first(), end = first + table.hessian_width();
        char free = 1;
        for (int a = first; a < end; ++a) {
          for (int b = first; b <= a; ++b) {
            const bool held = stencil[a] < 0 || stencil[b] < 0;
            if (held) free = 0;
            table.lasting_position.push_back(held ? -1 : lasting_pattern_.position(blocks_, stencil[a], stencil[b]));
          }
        }
        table.all_free.push_back(free);
      }
      if (!closure) continue;
      for (int a = 0; a < table.values(); ++a, ++row) {
        const auto first = closure_position_.size();
        for (int k = 0; k < table.width(); ++k) {
          closure_position_.push_back(stencil[k] < 0 ? -1 : jacobian_pattern_.position(row, stencil[k]));
        }
        note_closure_row(static_cast<int>(&table - tables_.data()), (i * table.values() + a) * table.width(),
                         closure_position_.data() + first);
      }
    }
  }
  count_closure_readers();
  node_fraction_.resize(scene_.curves.size());
  for (const SiteTable& table : tables_) {
    std::vector<double>& fraction = node_fraction_[at(table.curve)];
    const int edges = curve_of(table).view.nodes - 1;
    for (int i = static_cast<int>(fraction.size()); i < table.count(); ++i) {
      fraction.push_back(static_cast<double>(i) / edges);
    }
  }
}

void Assembly::make_patterns() {
  row_blocks_.clear();
  jacobian_pattern_.keep(closure_rows_);
  for (ConstraintRows& rows : constraints_) rows.add_patterns(blocks_, row_blocks_, jacobian_pattern_);
  hessian_pattern_.assign(blocks_, lasting_pattern_, row_blocks_, lasting_position_);
  for (ConstraintRows& rows : constraints_) rows.locate(blocks_, hessian_pattern_);
  for (SiteTable& table : tables_) {
    const auto count = table.lasting_position.size();
    table.hessian_position.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      const int lasting = table.lasting_position[k];
      table.hessian_position[k] = lasting < 0 ? -1 : lasting_position_[at(lasting)];
    }
  }
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

/// What `make_lasting_patterns` and `make_patterns` would make.
void Assembly::take_patterns(const Assembly& other) {
  lasting_pattern_ = other.lasting_pattern_;
  hessian_pattern_ = other.hessian_pattern_;
  jacobian_pattern_ = other.jacobian_pattern_;
  closure_position_ = other.closure_position_;
  closure_runs_ = other.closure_runs_;
  closure_in_run_ = other.closure_in_run_;
  order_ = other.order_;
  border_ = other.border_;
  whole_curve_ = other.whole_curve_;
  is_position_ = other.is_position_;
  closure_readers_ = other.closure_readers_;
  node_fraction_ = other.node_fraction_;
  local_rows_found_ = other.local_rows_found_;
  local_rows_of_constraints_ = other.local_rows_of_constraints_;
  local_rows_ = other.local_rows_;
  local_unknowns_ = other.local_unknowns_;
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    tables_[t].lasting_position = other.tables_[t].lasting_position;
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

void Assembly::count_closure_readers() {
  closure_readers_.assign(at(free_count_), 0);
  whole_curve_.assign(at(free_count_), 0);
  std::vector<int> of_table(at(free_count_), 0);
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure) continue;
    for (const int u : table.free_unknown) {
      if (u >= 0) ++of_table[at(u)], ++closure_readers_[at(u)];
    }
    constexpr int few = 2;  // edges that meet at a node
    for (const int u : table.free_unknown) {
      if (u < 0) continue;
      whole_curve_[at(u)] |= of_table[at(u)] > few && of_table[at(u)] == table.count();
      of_table[at(u)] = 0;
    }
  }
  is_position_.assign(at(free_count_), 0);
  for (const FieldEntry& entry : entries_) {
    if (entry.block < 0 || entry.manifold != Manifold::vector) continue;
    for (int u = blocks_.begin[at(entry.block)]; u < blocks_.begin[at(entry.block) + 1]; ++u) is_position_[at(u)] = 1;
  }
  local_rows_found_ = false;
}

void Assembly::find_local_rows() {
  const bool of_constraints = summary_.equalities > closure_rows_;
  if (local_rows_found_ && !of_constraints && !local_rows_of_constraints_) return;
  local_rows_found_ = true;
  local_rows_of_constraints_ = of_constraints;
  equality_readers_ = closure_readers_;
  for (const ConstraintRows& rows : constraints_) {
    for (int r = 0; of_constraints && r < rows.rows(); ++r) {
      if (row_lower_[at(rows.first_row + r)] != row_upper_[at(rows.first_row + r)]) continue;
      for (int k = rows.unknown_begin[at(r)]; k < rows.unknown_begin[at(r) + 1]; ++k) {
        if (rows.unknown[at(k)] >= 0) ++equality_readers_[at(rows.unknown[at(k)])];
      }
    }
  }
  local_rows_.clear();
  local_unknowns_.clear();
  int row = 0;
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure) continue;
    for (int i = 0; i < table.count(); ++i, row += table.values()) {
      LocalRows local{row, table.values(), static_cast<int>(local_unknowns_.size()), 0};
      for (int k = 0; k < table.width(); ++k) {
        const int u = table.free_unknown[at(i * table.width() + k)];
        if (u < 0 || equality_readers_[at(u)] != 1 || is_position_[at(u)] != 0) continue;
        local_unknowns_.push_back(u);
        ++local.locals;
      }
      if (local.locals > 0) local_rows_.push_back(local);
    }
  }
}

void Assembly::pair_places() {
  paired_places_.resize(scene_.curves.size());
  for (auto& pairs : paired_places_) pairs.clear();
  for (const ConstraintRows& rows : constraints_) {
    for (int r = 0; r < rows.rows(); ++r) {
      const int first = rows.read_begin[at(r)], end = rows.read_begin[at(r) + 1];
      if (first == end) continue;
      const int own = tables_[at(rows.reads[at(first)].table)].curve;
      double mine = 0.0, other = 0.0;
      int mine_count = 0, other_count = 0;
      for (int k = first; k < end; ++k) {
        const ConstraintRows::Read& read = rows.reads[at(k)];
        const int curve = tables_[at(read.table)].curve;
        (curve == own ? mine : other) += node_fraction_[at(curve)][at(read.index)];
        ++(curve == own ? mine_count : other_count);
      }
      if (other_count > 0) paired_places_[at(own)].emplace_back(mine / mine_count, other / other_count);
    }
  }
  for (auto& pairs : paired_places_) {
    if (!std::is_sorted(pairs.begin(), pairs.end())) std::sort(pairs.begin(), pairs.end());
  }
}

void Assembly::place_along() {
  std::size_t index = 0;
  for (const auto& curve : scene_.curves) {
    const auto& pairs = paired_places_[at(curve->view.index)];
    for (const FieldDeclaration& field : curve->declaration.fields) {
      auto next = pairs.begin();
      for (int i = 0; i < field.count; ++i, ++index) {
        const FieldEntry& entry = entries_[index];
        if (entry.block < 0) continue;
        double along = entry.arc_fraction;
        if (!pairs.empty()) {
          // The first that is not before `along`: entries come in order along their curve.
          if (next != pairs.begin() && !((next - 1)->first < along)) {
            next = std::lower_bound(pairs.begin(), pairs.end(), std::pair<double, double>{along, -infinity});
          }
          while (next != pairs.end() && next->first < along) ++next;
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
        for (int u = blocks_.begin[at(entry.block)]; u < blocks_.begin[at(entry.block) + 1]; ++u) key_[at(u)] = along;
      }
    }
  }
}

void Assembly::make_order() {
  const int n = free_count_;
  const int m = rows();
  key_.assign(at(n + m), -infinity);
  pair_places();
  place_along();
  border_ = 0;
  for (int u = 0; u < n; ++u) {
    if (whole_curve_[at(u)] == 0) continue;
    key_[at(u)] = infinity;
    ++border_;
  }
  const SparsityPattern pattern = jacobian_pattern_.view();
  for (int r = 0; r < m; ++r) {
    double largest = -infinity;
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      const double place = key_[at(pattern.inner[at(k)])];
      if (place < infinity) largest = std::max(largest, place);
    }
    key_[at(n + r)] = largest;
  }
  key_order_.sort(key_, order_);
}

}  // namespace bowstring
