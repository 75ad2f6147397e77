#include "core/assembly/assembly.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "core/assembly/euclidean.hpp"
#include "core/assembly/finite.hpp"
#include "core/model/declarations.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double largest_shortening = 0.5;               // of an edge, in one step
constexpr double largest_turn = 0.78539816339744830962;  // of a station, in one step

Status named(Status status, const std::string& what) {
  if (!status.ok()) status.text = what + ": " + status.text;
  return status;
}

/// A number that no other state in this process has: a scene may outlive its assemblies, and its plugins remember.
std::uint64_t new_state() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

Assembly::Assembly(Scene& scene, Span<const double> start, const Assembly* like) : scene_(scene) {
  number_unknowns();
  make_tables();
  q_.assign(at(scene_.coordinates), 0.0);
  if (!start.empty()) place_rows_at(start);
  number_rows();
  read_rows();
  term_energy_.assign(scene_.energies.size(), 0.0);
  make_scales();
  if (like != nullptr && reads_like(*like)) {
    take_patterns(*like);
  } else {
    make_lasting_patterns();
    make_patterns();
  }

  const std::vector<double> own = scene_.start_coordinates();
  if (Status status = accept(start.empty() ? own : start); !status.ok()) throw std::runtime_error(status.text);
  if (epoch_due()) {
    if (Status status = new_epoch(); !status.ok()) throw std::runtime_error(status.text);
    epochs_ = 1;
  }
}

void Assembly::place_rows_at(Span<const double> q) {
  Status status = update_places(q);
  if (status.ok()) status = update_idle_places();
  if (status.ok()) {
    status = place_rows(
        [](Constraint& constraint, const PlaceTables& at, RowDeclaration& out) { return constraint.bind(at, out); });
  }
  if (!status.ok()) throw std::runtime_error(status.text);
  has_places_ = false;  // rows may read sites that nothing has read before
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

Span<const double> Assembly::curve_q(int curve) const noexcept {
  const Curve& c = *scene_.curves[at(curve)];
  return {q_.data() + c.coordinate_begin, at(c.coordinates)};
}

const Curve& Assembly::curve_of(const SiteTable& table) const noexcept { return *scene_.curves[at(table.curve)]; }

Status Assembly::update_places(Span<const double> q, bool derivatives) {
  if (has_places_ && std::memcmp(q.data(), q_.data(), q.size() * sizeof(double)) == 0) return {};
  std::copy(q.begin(), q.end(), q_.begin());
  has_places_ = has_idle_places_ = has_energy_ = has_jacobians_ = has_rows_ = has_row_jacobians_ = guard_checked_ =
      false;
  state_ = place_state_ = new_state();
  for (SiteTable& table : tables_) {
    if (!table.read) continue;
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = derivatives ? table.update_values_and_jacobian(curve_q(table.curve), place_state_)
                                : table.update_values(curve_q(table.curve), place_state_);
    if (!status.ok()) return named(std::move(status), "curve '" + curve.name + "'");
  }
  has_places_ = true;
  has_jacobians_ = derivatives;
  return {};
}

Status Assembly::update_idle_places() {
  if (has_idle_places_) return {};
  for (SiteTable& table : tables_) {
    if (table.read) continue;
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_values(curve_q(table.curve), place_state_);
    if (!status.ok()) return named(std::move(status), "curve '" + curve.name + "'");
  }
  has_idle_places_ = true;
  return {};
}

Status Assembly::update_energy() {
  if (has_energy_) return {};
  std::fill(term_energy_.begin(), term_energy_.end(), 0.0);
  for (SiteTable& table : tables_) {
    if (table.pulls) std::fill(table.stress.begin(), table.stress.end(), 0.0);
  }
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
    if (!table.read) continue;
    const Curve& curve = *scene_.curves[at(table.curve)];
    Status status = table.update_jacobian(curve_q(table.curve), place_state_);
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
  if (Status status = update_idle_places(); !status.ok()) return guard_status_ = std::move(status);
  travelled_ = 0.0;
  for (const ConstraintUse& use : scene_.constraints) {
    travelled_ = std::max(travelled_, use.constraint->travel(*this).fraction_of_clearance);
  }
  if (travelled_ > guard_) {
    guard_status_.code = Code::refused;  // without text: this answer comes in the hot path
    return guard_status_;
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

Status Assembly::update_rows(bool jacobian, bool beyond_window) {
  if (!epoch_failure_.ok()) return epoch_failure_;
  beyond_window = beyond_window && !jacobian;
  if (has_row_jacobians_ && !(beyond_window && row_status_.code == Code::left_window)) return row_status_;
  if (has_rows_ && !jacobian && beyond_window == rows_beyond_window_) return row_status_;
  rows_beyond_window_ = beyond_window;
  row_status_ = {};
  double* out = row_.data();
  for (const SiteTable& table : tables_) {
    if (table.declaration->site == Site::closure) out = std::copy(table.y.begin(), table.y.end(), out);
  }
  for (std::size_t c = 0; c < constraints_.size() && row_status_.ok(); ++c)
    row_status_ = update_constraint(c, jacobian, beyond_window);
  has_rows_ = true;
  has_row_jacobians_ = jacobian;
  return row_status_;
}

Status Assembly::update_constraint(std::size_t index, bool jacobian, bool beyond_window) {
  const ConstraintUse& use = scene_.constraints[index];
  ConstraintRows& rows = constraints_[index];
  RowEvaluation evaluation;
  evaluation.at = this;
  evaluation.residual = {row_.data() + rows.first_row, at(rows.rows())};
  if (jacobian) evaluation.jacobian = rows.jacobian;
  evaluation.state = state_;
  evaluation.beyond_window = beyond_window;
  std::copy(rows.all_places.begin(), rows.all_places.end(), rows.jacobian_support.begin());
  if (jacobian) evaluation.support = rows.jacobian_support;
  Status status = use.constraint->evaluate(evaluation);
  if (status.code == Code::left_window) return status;  // without text: this answer comes in the hot path
  if (status.ok() && !all_finite(evaluation.residual.data(), evaluation.residual.size())) {
    int row = 0;
    while (std::isfinite(evaluation.residual[at(row)])) ++row;
    status = Status::failure(Code::failed, "row " + std::to_string(row) + " is not a finite number");
  }
  if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
  if (!jacobian) return {};
  if (Status flaw = check_supports(index, rows.jacobian_support, 0, rows.rows()); !flaw.ok()) return flaw;
  const int flawed = rows.flawed_jacobian_row();
  return flawed < 0 ? Status{} : not_finite(index, "derivative", flawed);
}

Status Assembly::check_supports(std::size_t index, const std::vector<RowSupport>& support, int first, int end) const {
  for (int r = first; r < end; ++r) {
    if (constraints_[index].fits(r, support[at(r)])) continue;
    return Status::failure(Code::failed, "constraint '" + scene_.constraints[index].label + "': row " +
                                             std::to_string(r) + " depends on places that it does not have");
  }
  return {};
}

Status Assembly::not_finite(std::size_t index, const char* what, int row) const {
  return Status::failure(Code::failed, "constraint '" + scene_.constraints[index].label + "': a " + what + " of row " +
                                           std::to_string(row) + " is not a finite number");
}

Status Assembly::evaluate(Span<const double> q, const ProblemEvaluation& evaluation) noexcept {
  const bool derivatives = !evaluation.gradient.empty() || !evaluation.jacobian.empty();
  if (Status status = update_places(q, derivatives); !status.ok()) return status;
  if (Status status = check_guard(); !status.ok()) return status;
  const bool wants_rows = !evaluation.rows.empty() || !evaluation.jacobian.empty();
  // A row that left its window makes the whole trial inadmissible, whatever was asked for.
  if (Status status = update_rows(!evaluation.jacobian.empty(), evaluation.beyond_window); !status.ok()) return status;
  if (wants_rows && !evaluation.rows.empty()) std::copy(row_.begin(), row_.end(), evaluation.rows.begin());

  if (evaluation.energy != nullptr || !evaluation.gradient.empty()) {
    if (Status status = update_energy(); !status.ok()) return status;
    if (evaluation.energy != nullptr) *evaluation.energy = energy_;
  }
  if (derivatives) {
    if (Status status = update_jacobians(); !status.ok()) return status;
  }
  if (!evaluation.gradient.empty()) {
    std::fill(evaluation.gradient.begin(), evaluation.gradient.end(), 0.0);
    for (const SiteTable& table : tables_) {
      if (table.pulls) table.add_gradient(table.stress, table.free_unknown, evaluation.gradient.data());
    }
  }
  if (!evaluation.jacobian.empty()) {
    std::fill(evaluation.jacobian.begin(), evaluation.jacobian.end(), 0.0);
    add_closure_jacobian(evaluation.jacobian);
    for (const ConstraintRows& rows : constraints_) rows.add_jacobian(tables_, evaluation.jacobian);
  }
  return {};
}

void Assembly::add_closure_jacobian(Span<double> out) const noexcept {
  for (const Run& run : closure_runs_) {
    std::copy_n(tables_[at(run.table)].jacobian.data() + run.first, run.count, out.data() + run.position);
  }
  const int* position = closure_position_.data();
  const char* in_run = closure_in_run_.data();
  for (const SiteTable& table : tables_) {
    if (table.declaration->site != Site::closure) continue;
    const int width = table.width();
    const double* entry = table.jacobian.data();
    for (int row = 0; row < table.count() * table.values(); ++row, entry += width, position += width) {
      if (*in_run++ != 0) continue;
      for (int k = 0; k < width; ++k) {
        if (position[k] >= 0) out[at(position[k])] += entry[k];
      }
    }
  }
}

Status Assembly::add_row_hessians(Span<const double> multipliers, Span<double> values) {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const ConstraintUse& use = scene_.constraints[c];
    ConstraintRows& rows = constraints_[c];
    std::copy(rows.all_places.begin(), rows.all_places.end(), rows.hessian_support.begin());
    for (int first = 0, end = 0; first < rows.rows(); first = end) {
      end = rows.part_end(first);
      RowEvaluation evaluation;
      evaluation.at = this;
      evaluation.state = state_;
      if (rows.in_parts) evaluation.first = first, evaluation.count = end - first;
      evaluation.weight = {multipliers.data() + rows.first_row + first, at(end - first)};
      evaluation.hessian = rows.hessian;
      evaluation.support = {rows.hessian_support.data() + first, at(end - first)};
      Status status = use.constraint->evaluate(evaluation);
      if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
      if (Status flaw = check_supports(c, rows.hessian_support, first, end); !flaw.ok()) return flaw;
      const int flawed = rows.flawed_hessian_row(first, end);
      if (flawed >= 0) return not_finite(c, "second derivative", flawed);
      rows.add_hessian(first, end, tables_, values);
    }
  }
  return {};
}

void Assembly::set_total_stress(double energy_factor, Span<const double> multipliers, bool everywhere) noexcept {
  int row = 0;
  for (SiteTable& table : tables_) {
    if (table.declaration->site == Site::closure) {
      for (double& stress : table.total_stress) stress = multipliers[at(row++)];
    } else if (everywhere || table.bends()) {
      for (std::size_t k = 0; k < table.stress.size(); ++k) table.total_stress[k] = energy_factor * table.stress[k];
    }
  }
  for (const ConstraintRows& rows : constraints_) {
    if (everywhere || !rows.identity) rows.add_stress(multipliers, tables_);
  }
}

Status Assembly::lagrangian_hessian(Span<const double> q, double energy_factor, Span<const double> multipliers,
                                    Span<double> values) noexcept {
  if (Status status = update_places(q, true); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  if (Status status = update_jacobians(); !status.ok()) return status;
  if (Status status = update_rows(true); !status.ok()) return status;
  std::fill(values.begin(), values.end(), 0.0);

  set_total_stress(energy_factor, multipliers, false);
  for (SiteTable& table : tables_) std::fill(table.modulus.begin(), table.modulus.end(), 0.0);
  for (LawSlot& slot : laws_) {
    if (Status status = slot.law.add_modulus(tables_[at(slot.table)]); !status.ok()) {
      return named(std::move(status), "energy '" + scene_.energies[at(slot.energy)].label + "'");
    }
  }
  if (Status status = add_row_hessians(multipliers, values); !status.ok()) return status;
  for (SiteTable& table : tables_) {
    if (!table.read) continue;
    Status status = table.update_curvature(curve_q(table.curve), place_state_);
    if (!status.ok()) return named(std::move(status), "curve '" + curve_of(table).name + "'");
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
  if (Status status = update_idle_places(); !status.ok()) return status;
  for (ConstraintUse& use : scene_.constraints) {
    Status status = use.constraint->accept(*this);
    if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
  }
  for (SiteTable& table : tables_) {
    if (table.declaration->site == Site::station || table.declaration->site == Site::edge) table.accepted = table.y;
  }
  // Searches now start elsewhere: what was computed at this state may differ in its last bits.
  has_rows_ = has_row_jacobians_ = guard_checked_ = false;
  state_ = new_state();
  return {};
}

double Assembly::rounding_floor() const noexcept {
  double floor = 0.0;
  for (const EnergyUse& use : scene_.energies) {
    double stiffest = 0.0;
    for (const LawUse& law : use.laws) {
      if (law.description.site != Site::station) continue;
      for (const std::vector<double>& parameter : law.parameters) {
        for (const double value : parameter) stiffest = std::max(stiffest, value);
      }
    }
    if (stiffest > 0.0) floor = std::max(floor, scene_.curves[at(use.curve)]->kinematics->rounding_floor(stiffest));
  }
  return floor;
}

bool Assembly::epoch_due() const noexcept {
  return std::any_of(scene_.constraints.begin(), scene_.constraints.end(),
                     [](const ConstraintUse& use) { return use.constraint->rebind_due(); });
}

Status Assembly::new_epoch() noexcept {
  epoch_failure_ = bind_rows();
  if (!epoch_failure_.ok()) return epoch_failure_;
  has_rows_ = has_row_jacobians_ = guard_checked_ = false;
  state_ = new_state();
  ++epochs_;
  return {};
}

Status Assembly::place_rows(Binding bind) {
  for (ConstraintUse& use : scene_.constraints) {
    const int rows = use.rows.rows;
    Status status = bind(*use.constraint, *this, use.rows);
    if (!status.ok()) return named(std::move(status), "constraint '" + use.label + "'");
    if (const std::string flaw = flaw_of(use.rows); !flaw.empty()) {
      return Status::failure(Code::failed, "constraint '" + use.label + "' " + flaw);
    }
    if (use.rows.rows != rows) {
      return Status::failure(Code::failed, "constraint '" + use.label + "' changed its number of rows in an epoch");
    }
  }
  return {};
}

Status Assembly::bind_rows() noexcept {
  try {
    Status status = place_rows(
        [](Constraint& constraint, const PlaceTables&, RowDeclaration& out) { return constraint.rebind(out); });
    if (!status.ok()) return status;
    if (rows_stay()) return {};
    if (read_rows()) {
      has_places_ = false;
      make_lasting_patterns();
    }
    make_patterns();
  } catch (const std::exception& error) {
    return Status::failure(Code::failed, error.what());
  }
  return {};
}

std::unique_ptr<EuclideanProblem> Assembly::chart(Span<const double> base) {
  return std::make_unique<EuclideanChart>(*this, base);
}

double Assembly::largest_motion(Span<const double> from, Span<const double> to) const noexcept {
  double largest = 0.0;
  for (const FieldEntry& entry : entries_) {
    if (entry.manifold != Manifold::vector) continue;
    double squared = 0.0;
    for (int k = entry.coordinate; k < entry.coordinate + entry.dimension; ++k) {
      squared += (to[at(k)] - from[at(k)]) * (to[at(k)] - from[at(k)]);
    }
    largest = std::max(largest, std::sqrt(squared));
  }
  return largest;
}

Status Assembly::term_energies(Span<const double> q, std::vector<double>& out) {
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  out = term_energy_;
  return {};
}

Status Assembly::full_gradient(Span<const double> q, Span<const double> multipliers, std::vector<double>& out) {
  if (Status status = update_places(q, true); !status.ok()) return status;
  if (Status status = update_energy(); !status.ok()) return status;
  if (Status status = update_jacobians(); !status.ok()) return status;
  if (Status status = update_rows(true); !status.ok()) return status;
  set_total_stress(1.0, multipliers, true);
  out.assign(at(scene_.unknowns), 0.0);
  for (const SiteTable& table : tables_) {
    if (table.read) table.add_gradient(table.total_stress, table.unknown, out.data());
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
  if (!epoch_failure_.ok()) return epoch_failure_;
  if (Status status = update_places(q); !status.ok()) return status;
  if (Status status = update_idle_places(); !status.ok()) return status;
  return scene_.constraints[at(constraint)].constraint->report(*this, out);
}

}  // namespace bowstring
