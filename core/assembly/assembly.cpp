#include "core/assembly/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>

#include "core/assembly/euclidean.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double largest_shortening = 0.5;                // of an edge, in one step
constexpr double largest_turn = 0.78539816339744830962;   // of a station, in one step
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Local arc-length spacing of a curve's edges around a fraction of its length.
double local_edge_length(const CurveView& view, double arc_fraction) {
  const int edges = view.nodes - 1;
  const double position = arc_fraction * edges - 0.5;
  const int edge = std::clamp(static_cast<int>(std::lround(position)), 0, edges - 1);
  return view.edge_length[edge];
}

}  // namespace

Assembly::Assembly(Scene& scene) : scene_(scene) {
  number_unknowns();
  make_tables();
  make_rows();
  q_.assign(at(scene_.coordinates), 0.0);
  full_gradient_.assign(at(scene_.unknowns), 0.0);
  full_delta_.assign(at(scene_.unknowns), 0.0);
  term_energy_.assign(scene_.energies.size(), 0.0);
  make_scales();
  make_patterns();

  const std::vector<double> start = scene_.start_coordinates();
  if (Status status = accept(start); !status.ok()) throw std::runtime_error(status.text);
  if (epoch_due()) {
    if (Status status = new_epoch(); !status.ok()) throw std::runtime_error(status.text);
    epochs_ = 1;
  }
}

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
    }
  }
  const std::vector<double> reference = scene_.reference_coordinates();
  std::vector<std::vector<double>> reference_y;
  for (SiteTable& table : tables_) {
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_values(reference.data() + curve.coordinate_begin, curve.coordinates);
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
      if (!law.description.linear || table.declaration->lengths_vary) {
        table.modulus.assign(at(table.count() * packed_size(table.values())), 0.0);
      }
    }
  }
}

Assembly::ConstraintSlot Assembly::make_slot(const ConstraintUse& use, int first_row) const {
  ConstraintSlot slot;
  slot.first_row = first_row;
  const RowDeclaration& rows = use.rows;
  slot.jacobian_begin.assign(1, 0);
  slot.hessian_begin.assign(1, 0);
  slot.unknown_begin.assign(1, 0);
  for (int r = 0; r < rows.rows; ++r) {
    int numbers = 0;
    for (int p = rows.place_begin[at(r)]; p < rows.place_begin[at(r) + 1]; ++p) {
      const Place& place = rows.places[at(p)];
      const int index = table_of_[at(place.curve * site_count + static_cast<int>(place.site))];
      if (index < 0 || place.index < 0 || place.index >= tables_[at(index)].count()) {
        throw std::runtime_error("constraint '" + use.label + "': row " + std::to_string(r) +
                                 " reads a place that curve '" + scene_.curves[at(place.curve)]->name +
                                 "' does not have");
      }
      const SiteTable& table = tables_[at(index)];
      slot.reads.push_back({index, place.index, table.values(), table.width(), table.declaration->identity});
      slot.identity = slot.identity && table.declaration->identity;
      numbers += table.values();
      for (int k = 0; k < table.width(); ++k) {
        const int unknown = table.unknown[at(place.index * table.width() + k)];
        slot.unknown.push_back(unknown < 0 ? -1 : free_[at(unknown)]);
      }
    }
    slot.jacobian_begin.push_back(slot.jacobian_begin.back() + numbers);
    slot.hessian_begin.push_back(slot.hessian_begin.back() + packed_size(numbers));
    slot.unknown_begin.push_back(static_cast<int>(slot.unknown.size()));
  }
  slot.jacobian.assign(at(slot.jacobian_begin.back()), 0.0);
  slot.hessian.assign(at(slot.hessian_begin.back()), 0.0);
  return slot;
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
    const std::string text = curve.declaration.closure_name + " of '" + curve.name + "' (" + std::to_string(count) + ")";
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
    constraints_.push_back(make_slot(use, first));
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
  row_weight_.assign(row_lower_.size(), 0.0);
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
  const auto has_second_order = [](const SiteTable& table) { return !table.modulus.empty() || table.bends(); };

  for (const SiteTable& table : tables_) {
    for (int i = 0; i < table.count(); ++i) {
      stencil(table, i);
      if (has_second_order(table)) hessian_pattern_.couple(blocks_, free_stencil.data(), table.width());
      if (table.declaration->site != Site::closure) continue;
      for (int a = 0; a < table.values(); ++a) jacobian_pattern_.add_row(free_stencil.data(), table.width());
    }
  }
  for (const ConstraintSlot& slot : constraints_) {
    for (std::size_t r = 0; r + 1 < slot.unknown_begin.size(); ++r) {
      const int* unknown = slot.unknown.data() + slot.unknown_begin[r];
      const int count = slot.unknown_begin[r + 1] - slot.unknown_begin[r];
      hessian_pattern_.couple(blocks_, unknown, count);
      jacobian_pattern_.add_row(unknown, count);
    }
  }
  hessian_pattern_.finish(blocks_);

  closure_position_.clear();
  int row = 0;
  for (SiteTable& table : tables_) {
    table.hessian_position.clear();
    const bool closure = table.declaration->site == Site::closure;
    for (int i = 0; i < table.count(); ++i) {
      stencil(table, i);
      if (has_second_order(table)) {
        for (int a = 0; a < table.width(); ++a) {
          for (int b = 0; b <= a; ++b) {
            const int ua = free_stencil[at(a)];
            const int ub = free_stencil[at(b)];
            table.hessian_position.push_back(ua < 0 || ub < 0 ? -1 : hessian_pattern_.position(blocks_, ua, ub));
          }
        }
      }
      if (!closure) continue;
      for (int a = 0; a < table.values(); ++a, ++row) {
        for (const int u : free_stencil) closure_position_.push_back(u < 0 ? -1 : jacobian_pattern_.position(row, u));
      }
    }
  }
  for (ConstraintSlot& slot : constraints_) locate_constraint(slot);
  make_order();
}

void Assembly::locate_constraint(ConstraintSlot& slot) {
  slot.jacobian_position.clear();
  slot.hessian_position.clear();
  slot.hessian_position_begin.assign(1, 0);
  for (std::size_t r = 0; r + 1 < slot.unknown_begin.size(); ++r) {
    const int row = slot.first_row + static_cast<int>(r);
    const int* unknown = slot.unknown.data() + slot.unknown_begin[r];
    const int count = slot.unknown_begin[r + 1] - slot.unknown_begin[r];
    for (int a = 0; a < count; ++a) {
      slot.jacobian_position.push_back(unknown[a] < 0 ? -1 : jacobian_pattern_.position(row, unknown[a]));
      for (int b = 0; b <= a; ++b) {
        slot.hessian_position.push_back(
            unknown[a] < 0 || unknown[b] < 0 ? -1 : hessian_pattern_.position(blocks_, unknown[a], unknown[b]));
      }
    }
    slot.hessian_position_begin.push_back(static_cast<int>(slot.hessian_position.size()));
  }
}

void Assembly::make_order() {
  const int n = free_count_;
  const int m = rows();
  std::vector<double> key(at(n + m), 0.0);
  for (const FieldEntry& entry : entries_) {
    if (entry.block < 0) continue;
    // A curve's length reads the whole curve: it comes last.
    const double place = entry.manifold == Manifold::real && blocks_.size(entry.block) == 1 && entry.arc_fraction > 1.5
                             ? infinity
                             : entry.arc_fraction;
    for (int u = blocks_.begin[at(entry.block)]; u < blocks_.begin[at(entry.block) + 1]; ++u) key[at(u)] = place;
  }
  const SparsityPattern pattern = jacobian_pattern_.view();
  for (int r = 0; r < m; ++r) {
    double last = 0.0;
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      const double place = key[at(pattern.inner[at(k)])];
      if (place < infinity) last = std::max(last, place);
    }
    key[at(n + r)] = last;
  }
  order_.resize(at(n + m));
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return key[at(a)] < key[at(b)]; });
}

SiteTable* Assembly::find_table(int curve, Site site) noexcept {
  const int index = table_of_[at(curve * site_count + static_cast<int>(site))];
  return index < 0 ? nullptr : &tables_[at(index)];
}

const SiteTable* Assembly::find_table(int curve, Site site) const noexcept {
  const int index = table_of_[at(curve * site_count + static_cast<int>(site))];
  return index < 0 ? nullptr : &tables_[at(index)];
}

const double* Assembly::table(int curve, Site site) const noexcept {
  const SiteTable* found = find_table(curve, site);
  return found == nullptr ? nullptr : found->y.data();
}

const double* Assembly::curve_q(int curve) const noexcept {
  return q_.data() + scene_.curves[at(curve)]->coordinate_begin;
}

Status Assembly::named(Status status, const std::string& what) const {
  if (!status.ok()) status.text = what + ": " + status.text;
  return status;
}

Status Assembly::update_places(Span<const double> q) {
  if (has_places_ && std::memcmp(q.data(), q_.data(), q.size() * sizeof(double)) == 0) return {};
  std::copy(q.begin(), q.end(), q_.begin());
  has_places_ = has_energy_ = has_jacobians_ = has_rows_ = has_row_jacobians_ = guard_checked_ = false;
  for (SiteTable& table : tables_) {
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_values(curve_q(table.curve), curve.coordinates);
    if (!status.ok()) return named(std::move(status), "curve '" + curve.name + "'");
  }
  has_places_ = true;
  return {};
}

Status Assembly::update_energy() {
  if (has_energy_) return {};
  std::fill(term_energy_.begin(), term_energy_.end(), 0.0);
  for (SiteTable& table : tables_) std::fill(table.stress.begin(), table.stress.end(), 0.0);
  for (LawSlot& slot : laws_) {
    SiteTable& table = tables_[at(slot.table)];
    Status status = slot.law.evaluate(table, &term_energy_[at(slot.energy)]);
    if (!status.ok()) {
      return named(std::move(status), "energy '" + scene_.energies[at(slot.energy)].label + "' on '" +
                                          scene_.curves[at(table.curve)]->name + "'");
    }
  }
  energy_ = 0.0;
  for (const double term : term_energy_) energy_ += term;
  has_energy_ = true;
  return {};
}

Status Assembly::update_jacobians() {
  if (has_jacobians_) return {};
  for (SiteTable& table : tables_) {
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_jacobian(curve_q(table.curve), curve.coordinates);
    if (!status.ok()) return named(std::move(status), "curve '" + curve.name + "'");
  }
  has_jacobians_ = true;
  return {};
}

Status Assembly::check_guard() {
  if (guard_checked_) return guard_status_;
  guard_checked_ = true;
  guard_status_ = {};
  if (!std::isfinite(guard_)) return guard_status_;
  for (std::size_t c = 0; c < scene_.constraints.size(); ++c) {
    const Travel travel = scene_.constraints[c].constraint->travel(*this);
    if (travel.fraction_of_clearance > guard_) {
      guard_status_.code = Code::refused;  // without text: this answer comes in the hot path
      return guard_status_;
    }
  }
  if (std::any_of(tables_.begin(), tables_.end(), [&](const SiteTable& table) { return folds(table); })) {
    guard_status_.code = Code::refused;
  }
  return guard_status_;
}

bool Assembly::folds(const SiteTable& table) const noexcept {
  const Site site = table.declaration->site;
  if ((site != Site::edge && site != Site::station) || table.accepted.empty()) return false;
  const int components = table.values() - (table.declaration->lengths_vary ? 2 : 0);
  for (int i = 0; i < table.count(); ++i) {
    const double* now = table.y.data() + i * table.values();
    const double* before = table.accepted.data() + i * table.values();
    if (site == Site::edge) {
      if (now[0] < largest_shortening * before[0]) return true;
      continue;
    }
    double change = 0.0;
    for (int k = 0; k < components; ++k) change += (now[k] - before[k]) * (now[k] - before[k]);
    if (change > largest_turn * largest_turn) return true;
  }
  return false;
}

Status Assembly::update_rows(bool jacobian) {
  if (has_row_jacobians_ || (has_rows_ && !jacobian)) return row_status_;
  row_status_ = {};
  double* out = row_.data();
  for (const SiteTable& table : tables_) {
    if (table.declaration->site == Site::closure) out = std::copy(table.y.begin(), table.y.end(), out);
  }
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    ConstraintSlot& slot = constraints_[c];
    const ConstraintUse& use = scene_.constraints[c];
    RowEvaluation evaluation;
    evaluation.at = this;
    evaluation.residual = {row_.data() + slot.first_row, at(use.rows.rows)};
    if (jacobian) evaluation.jacobian = slot.jacobian;
    Status status = use.constraint->evaluate(evaluation);
    if (!status.ok()) {
      row_status_ = status.code == Code::left_window ? std::move(status)
                                                     : named(std::move(status), "constraint '" + use.label + "'");
      break;
    }
    for (int r = 0; r < use.rows.rows; ++r) {
      if (std::isfinite(row_[at(slot.first_row + r)])) continue;
      row_status_ = Status::failure(Code::failed, "constraint '" + use.label + "': row " + std::to_string(r) +
                                                      " is not a finite number");
      break;
    }
  }
  has_rows_ = true;
  has_row_jacobians_ = jacobian;
  return row_status_;
}

void Assembly::scatter_jacobian(const ConstraintSlot& slot, Span<double> out) const noexcept {
  if (slot.identity) {
    for (std::size_t k = 0; k < slot.jacobian.size(); ++k) {
      if (slot.jacobian_position[k] >= 0) out[at(slot.jacobian_position[k])] += slot.jacobian[k];
    }
    return;
  }
  const double* r_y = slot.jacobian.data();
  const int* position = slot.jacobian_position.data();
  for (const RowRead& read : slot.reads) {
    const SiteTable& table = tables_[at(read.table)];
    const double* b = read.identity ? nullptr : table.jacobian.data() + at(read.index * read.values * read.width);
    for (int k = 0; k < read.width; ++k) {
      if (position[k] < 0) continue;
      double sum = read.identity ? r_y[k] : 0.0;
      for (int a = 0; b != nullptr && a < read.values; ++a) sum += r_y[a] * b[a * read.width + k];
      out[at(position[k])] += sum;
    }
    r_y += read.values;
    position += read.width;
  }
}

Status Assembly::evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept {
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = check_guard(); !status.ok()) return status;
  const bool wants_rows = !evaluation.rows.empty() || !evaluation.jacobian.empty();
  // A row that left its window makes the whole trial inadmissible, whatever was asked for.
  if (Status status = update_rows(!evaluation.jacobian.empty()); !status.ok()) return status;
  if (wants_rows && !evaluation.rows.empty()) std::copy(row_.begin(), row_.end(), evaluation.rows.begin());

  if (evaluation.energy != nullptr || !evaluation.gradient.empty()) {
    if (Status status = update_energy(); !status.ok()) return status;
    if (evaluation.energy != nullptr) *evaluation.energy = energy_;
  }
  if (!evaluation.gradient.empty() || !evaluation.jacobian.empty()) {
    if (Status status = update_jacobians(); !status.ok()) return status;
  }
  if (!evaluation.gradient.empty()) {
    std::fill(full_gradient_.begin(), full_gradient_.end(), 0.0);
    for (const SiteTable& table : tables_) {
      if (table.declaration->site != Site::closure) table.add_gradient(table.stress, full_gradient_.data());
    }
    for (std::size_t u = 0; u < free_.size(); ++u) {
      if (free_[u] >= 0) evaluation.gradient[at(free_[u])] = full_gradient_[u];
    }
  }
  if (!evaluation.jacobian.empty()) {
    std::fill(evaluation.jacobian.begin(), evaluation.jacobian.end(), 0.0);
    const int* position = closure_position_.data();
    for (const SiteTable& table : tables_) {
      if (table.declaration->site != Site::closure) continue;
      for (const double entry : table.jacobian) {
        if (*position >= 0) evaluation.jacobian[at(*position)] += entry;
        ++position;
      }
    }
    for (const ConstraintSlot& slot : constraints_) scatter_jacobian(slot, evaluation.jacobian);
  }
  return {};
}

Status Assembly::add_constraint_hessian(ConstraintSlot& slot, Span<const double> multipliers, Span<double> values) {
  const auto c = static_cast<std::size_t>(&slot - constraints_.data());
  const ConstraintUse& use = scene_.constraints[c];
  RowEvaluation evaluation;
  evaluation.at = this;
  evaluation.weight = {multipliers.data() + slot.first_row, at(use.rows.rows)};
  evaluation.hessian = slot.hessian;
  Status status = use.constraint->evaluate(evaluation);
  if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
  if (slot.identity) {
    for (std::size_t k = 0; k < slot.hessian.size(); ++k) {
      if (slot.hessian_position[k] >= 0) values[at(slot.hessian_position[k])] += slot.hessian[k];
    }
    return {};
  }
  // Bᵀ H B over the row's places, block by block.
  std::size_t read_begin = 0;
  for (int r = 0; r < use.rows.rows; ++r) {
    const auto read_end = at(use.rows.place_begin[at(r) + 1]);
    const double* h = slot.hessian.data() + slot.hessian_begin[at(r)];
    const int* position = slot.hessian_position.data() + slot.hessian_position_begin[at(r)];
    int row_y = 0;
    int row_u = 0;
    for (std::size_t p = read_begin; p < read_end; ++p) {
      const RowRead& a = slot.reads[p];
      const double* ba = a.identity ? nullptr : tables_[at(a.table)].jacobian.data() + at(a.index * a.values * a.width);
      int column_y = 0;
      int column_u = 0;
      for (std::size_t s = read_begin; s <= p; ++s) {
        const RowRead& b = slot.reads[s];
        const double* bb =
            b.identity ? nullptr : tables_[at(b.table)].jacobian.data() + at(b.index * b.values * b.width);
        for (int i = 0; i < a.width; ++i) {
          for (int j = 0; j < b.width && row_u + i >= column_u + j; ++j) {
            double sum = 0.0;
            for (int y = 0; y < a.values; ++y) {
              const double left = ba != nullptr ? ba[y * a.width + i] : (y == i ? 1.0 : 0.0);
              if (left == 0.0) continue;
              for (int z = 0; z < b.values; ++z) {
                const double right = bb != nullptr ? bb[z * b.width + j] : (z == j ? 1.0 : 0.0);
                const int yi = row_y + y;
                const int zi = column_y + z;
                sum += left * right * h[yi >= zi ? packed_index(yi, zi) : packed_index(zi, yi)];
              }
            }
            const int where = position[packed_index(row_u + i, column_u + j)];
            if (where >= 0) values[at(where)] += sum;
          }
        }
        column_y += b.values;
        column_u += b.width;
      }
      row_y += a.values;
      row_u += a.width;
    }
    read_begin = read_end;
  }
  return {};
}

Status Assembly::lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                                    Span<double> values) noexcept {
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  if (Status status = update_jacobians(); !status.ok()) return status;
  if (Status status = update_rows(true); !status.ok()) return status;
  std::fill(values.begin(), values.end(), 0.0);

  int row = 0;
  for (SiteTable& table : tables_) {
    std::fill(table.modulus.begin(), table.modulus.end(), 0.0);
    if (table.declaration->site == Site::closure) {
      for (double& stress : table.total_stress) stress = multipliers[at(row++)];
    } else {
      for (std::size_t k = 0; k < table.stress.size(); ++k) table.total_stress[k] = energy_factor * table.stress[k];
    }
  }
  for (LawSlot& slot : laws_) {
    if (Status status = slot.law.add_modulus(tables_[at(slot.table)]); !status.ok()) {
      return named(std::move(status), "energy '" + scene_.energies[at(slot.energy)].label + "'");
    }
  }
  for (ConstraintSlot& slot : constraints_) {
    if (Status status = add_constraint_hessian(slot, multipliers, values); !status.ok()) return status;
    if (slot.identity) continue;
    const double* r_y = slot.jacobian.data();
    std::size_t p = 0;
    for (std::size_t r = 0; r + 1 < slot.jacobian_begin.size(); ++r) {
      const double weight = multipliers[at(slot.first_row) + r];
      for (const double* end = slot.jacobian.data() + slot.jacobian_begin[r + 1]; r_y < end; ++p) {
        const RowRead& read = slot.reads[p];
        double* stress = tables_[at(read.table)].total_stress.data() + at(read.index * read.values);
        for (int k = 0; k < read.values; ++k) stress[k] += weight * *r_y++;
      }
    }
  }
  for (SiteTable& table : tables_) {
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_curvature(curve_q(table.curve), curve.coordinates);
    if (!status.ok()) return named(std::move(status), "curve '" + curve.name + "'");
    table.add_hessian(energy_factor, values.data());
  }
  return {};
}

void Assembly::values(Span<const double> q, Span<double> out) const noexcept {
  std::fill(out.begin(), out.end(), 0.0);
  for (const FieldEntry& entry : entries_) {
    if (entry.block < 0 || entry.manifold != Manifold::real) continue;
    out[at(blocks_.begin[at(entry.block)])] = q[at(entry.coordinate)];
  }
}

void Assembly::retract(Span<const double> q, Span<const double> delta, Span<double> out) const noexcept {
  for (const FieldEntry& entry : entries_) {
    double local[3] = {0.0, 0.0, 0.0};
    const int tangents = tangent_count(entry.manifold, entry.dimension);
    for (int k = 0; k < tangents; ++k) {
      const int u = free_[at(entry.unknown + k)];
      if (u >= 0) local[k] = delta[at(u)];
    }
    if (entry.block < 0) {
      const int numbers = coordinate_count(entry.manifold, entry.dimension);
      std::copy_n(q.begin() + entry.coordinate, numbers, out.begin() + entry.coordinate);
    } else {
      bowstring::retract(entry.manifold, entry.dimension, q.data() + entry.coordinate, local,
                         out.data() + entry.coordinate);
    }
  }
}

Status Assembly::accept(Span<const double> q) noexcept {
  if (Status status = update_places(q); !status.ok()) return status;
  for (ConstraintUse& use : scene_.constraints) {
    Status status = use.constraint->accept(*this);
    if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
  }
  for (SiteTable& table : tables_) {
    if (table.declaration->site == Site::station || table.declaration->site == Site::edge) table.accepted = table.y;
  }
  // Searches now start elsewhere: what was computed at this state may differ in its last bits.
  has_rows_ = has_row_jacobians_ = guard_checked_ = false;
  return {};
}

bool Assembly::epoch_due() const noexcept {
  return std::any_of(scene_.constraints.begin(), scene_.constraints.end(),
                     [](const ConstraintUse& use) { return use.constraint->rebind_due(); });
}

Status Assembly::new_epoch() noexcept {
  try {
    for (ConstraintUse& use : scene_.constraints) {
      const int rows = use.rows.rows;
      Status status = use.constraint->rebind(use.rows);
      if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
      if (use.rows.rows != rows) {
        return Status::failure(Code::failed, "constraint '" + use.label + "' changed its number of rows in an epoch");
      }
    }
    make_rows();
    make_patterns();
  } catch (const std::exception& error) {
    return Status::failure(Code::failed, error.what());
  }
  has_rows_ = has_row_jacobians_ = false;
  ++epochs_;
  return {};
}

std::unique_ptr<EuclideanProblem> Assembly::chart(Span<const double> base) {
  return std::make_unique<EuclideanChart>(*this, base);
}

Status Assembly::term_energies(Span<const double> q, std::vector<double>& out) {
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  out = term_energy_;
  return {};
}

Status Assembly::full_gradient(Span<const double> q, Span<const double> multipliers, std::vector<double>& out) {
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  if (Status status = update_jacobians(); !status.ok()) return status;
  if (Status status = update_rows(true); !status.ok()) return status;
  out.assign(at(scene_.unknowns), 0.0);
  int row = 0;
  for (SiteTable& table : tables_) {
    if (table.declaration->site == Site::closure) {
      for (double& stress : table.total_stress) stress = multipliers[at(row++)];
      table.add_gradient(table.total_stress, out.data());
    } else {
      table.add_gradient(table.stress, out.data());
    }
  }
  for (const ConstraintSlot& slot : constraints_) {
    std::size_t p = 0;
    for (std::size_t r = 0; r + 1 < slot.jacobian_begin.size(); ++r) {
      const double weight = multipliers[at(slot.first_row) + r];
      for (int k = slot.jacobian_begin[r]; k < slot.jacobian_begin[r + 1]; ++p) {
        const RowRead& read = slot.reads[p];
        const SiteTable& table = tables_[at(read.table)];
        const int* unknown = table.unknown.data() + at(read.index * read.width);
        const double* b = read.identity ? nullptr : table.jacobian.data() + at(read.index * read.values * read.width);
        for (int i = 0; i < read.width; ++i) {
          if (unknown[i] < 0) continue;
          double sum = read.identity ? slot.jacobian[at(k + i)] : 0.0;
          for (int a = 0; b != nullptr && a < read.values; ++a) {
            sum += slot.jacobian[at(k + a)] * b[a * read.width + i];
          }
          out[at(unknown[i])] += weight * sum;
        }
        k += read.values;
      }
    }
  }
  return {};
}

Status Assembly::site_stress(Span<const double> q, int curve, Site site, std::vector<double>& out) {
  out.clear();
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  if (const SiteTable* found = find_table(curve, site); found != nullptr) out = found->stress;
  return {};
}

Status Assembly::report(Span<const double> q, int constraint, std::vector<RowReport>& out) {
  if (Status status = update_places(q); !status.ok()) return status;
  return scene_.constraints[at(constraint)].constraint->report(*this, out);
}

}  // namespace bowstring
