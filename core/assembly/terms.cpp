// One energy at a time, for whoever judges terms and not their sum.

#include <algorithm>

#include "core/assembly/assembly.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Status named(Status status, const std::string& what) {
  if (!status.ok()) status.text = what + ": " + status.text;
  return status;
}

}  // namespace

Status Assembly::sum_term(Span<const double> q, int term, bool modulus) {
  if (Status status = update_places(q, true); !status.ok()) return status;
  if (Status status = update_jacobians(); !status.ok()) return status;
  has_energy_ = false;  // the tables' stress is no longer that of the sum
  for (SiteTable& table : tables_) {
    std::fill(table.stress.begin(), table.stress.end(), 0.0);
    if (modulus) std::fill(table.modulus.begin(), table.modulus.end(), 0.0);
  }
  double energy = 0.0;
  for (LawSlot& slot : laws_) {
    if (slot.energy != term) continue;
    SiteTable& table = tables_[at(slot.table)];
    Status status = slot.law.evaluate(table, &energy);
    if (status.ok() && modulus) status = slot.law.add_modulus(table);
    if (!status.ok()) return named(std::move(status), "energy '" + scene_.energies[at(term)].label + "'");
  }
  return {};
}

Status Assembly::term_gradient(Span<const double> q, int term, std::vector<double>& out) {
  if (Status status = sum_term(q, term, false); !status.ok()) return status;
  out.assign(at(scene_.unknowns), 0.0);
  for (const SiteTable& table : tables_) {
    if (table.pulls) table.add_gradient(table.stress, table.unknown, out.data());
  }
  return {};
}

Status Assembly::term_hessian(Span<const double> q, int term, Span<double> values) {
  if (Status status = sum_term(q, term, true); !status.ok()) return status;
  std::fill(values.begin(), values.end(), 0.0);
  for (SiteTable& table : tables_) {
    if (!table.pulls) continue;
    table.total_stress = table.stress;
    Status status = table.update_curvature(curve_q(table.curve), place_state_);
    if (!status.ok()) return named(std::move(status), "curve '" + curve_of(table).name + "'");
    table.add_hessian(1.0, values.data());
  }
  return {};
}

}  // namespace bowstring
