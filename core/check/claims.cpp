#include "core/check/claims.hpp"

#include <algorithm>
#include <cmath>

#include "core/check/unknowns.hpp"

namespace bowstring::checking {

namespace {

using Kind = Quantity::Kind;

constexpr double row_floor = 0.1;   // rows of one group: one with a tenth of the largest gradient counts by its own
constexpr double least_row = 1e-2;  // a row's gradient should be near 1: a smaller one counts as so much
constexpr double least_displacement =
    1e-4;  // of a step: a gradient smaller than what it would change counts as so much

}  // namespace

std::vector<Quantity> quantities(const Assembly& assembly) {
  const Scene& scene = assembly.scene();
  std::vector<Quantity> out;
  for (int e = 0; e < static_cast<int>(scene.energies.size()); ++e) {
    out.push_back({Kind::term_gradient, e, term_name(scene, e), "gradient"});
    out.push_back({Kind::term_hessian, e, term_name(scene, e), "Hessian"});
  }
  for (int g = 0; g < static_cast<int>(assembly.row_origins().size()); ++g) {
    const std::string name = origin_name(scene, assembly.row_origins()[at(g)]);
    out.push_back({Kind::rows, g, name, "Jacobian"});
    out.push_back({Kind::row_hessian, g, name, "Hessian"});
  }
  out.push_back({Kind::lagrangian_gradient, 0, "the assembled Lagrangian", "gradient"});
  out.push_back({Kind::lagrangian_hessian, 0, "the assembled Lagrangian", "Hessian"});
  return out;
}

const std::vector<double>* sample(const Quantity& quantity, const Probe& probe) noexcept {
  if (quantity.reads_energies() && !probe.energy_status.ok()) return nullptr;
  if (quantity.reads_rows() && !probe.row_status.ok()) return nullptr;
  switch (quantity.kind) {
    case Kind::term_gradient:
      return &probe.energy[at(quantity.index)];
    case Kind::term_hessian:
      return &probe.gradient[at(quantity.index)];
    case Kind::rows:
      return &probe.rows[at(quantity.index)];
    case Kind::row_hessian:
      return &probe.pull[at(quantity.index)];
    case Kind::lagrangian_gradient:
      return &probe.lagrangian;
    case Kind::lagrangian_hessian:
      break;
  }
  return &probe.lagrangian_gradient;
}

Claims::Claims(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& multipliers)
    : assembly_(assembly), steps_(natural_steps(assembly)), field_of_(at(assembly.unknowns())) {
  int field = 0;
  for (const FieldGroup& group : field_groups(assembly)) {
    std::fill(field_of_.begin() + group.begin, field_of_.begin() + group.end, field++);
  }
  for (const double number : q) largest_coordinate_ = std::max(largest_coordinate_, std::fabs(number));
  claim_terms(q);
  claim_rows(q, multipliers);
}

void Claims::claim_terms(const std::vector<double>& q) {
  std::vector<double> all;
  for (int e = 0; e < static_cast<int>(assembly_.scene().energies.size()); ++e) {
    term_gradient_.emplace_back(at(assembly_.unknowns()));
    term_hessian_.emplace_back(at(assembly_.hessian_pattern().entries()));
    Status status = assembly_.term_gradient(q, e, all);
    if (status.ok()) {
      term_gradient_.back() = free_part(assembly_, all);
      status = assembly_.term_hessian(q, e, term_hessian_.back());
    }
    term_status_.push_back(std::move(status));
  }
}

void Claims::claim_rows(const std::vector<double>& q, const std::vector<double>& multipliers) {
  const std::size_t entries = at(assembly_.hessian_pattern().entries());
  jacobian_.resize(at(assembly_.jacobian_pattern().entries()));
  lagrangian_gradient_.resize(at(assembly_.unknowns()));
  lagrangian_hessian_.resize(entries);
  ProblemEvaluation wanted;
  wanted.jacobian = jacobian_;
  const Status rows = assembly_.evaluate(q, wanted);
  for (const RowOrigin& origin : assembly_.row_origins()) {
    std::vector<double> own(multipliers.size(), 0.0);
    std::copy_n(multipliers.begin() + origin.first, origin.count, own.begin() + origin.first);
    group_hessian_.emplace_back(entries);
    group_status_.push_back(rows.ok() ? assembly_.lagrangian_hessian(q, 0.0, own, group_hessian_.back()) : rows);
  }
  wanted = {};
  wanted.gradient = lagrangian_gradient_;
  lagrangian_status_ = assembly_.evaluate(q, wanted);
  if (lagrangian_status_.ok()) {
    lagrangian_status_ = assembly_.lagrangian_hessian(q, energy_factor, multipliers, lagrangian_hessian_);
  }
  if (!lagrangian_status_.ok()) return;
  const RowOrigin whole{-1, -1, 0, assembly_.rows(), ""};
  const std::vector<double> pull =
      transposed_product(assembly_.jacobian_pattern(), jacobian_, whole, multipliers, assembly_.unknowns());
  for (std::size_t u = 0; u < pull.size(); ++u) {
    lagrangian_gradient_[u] = energy_factor * lagrangian_gradient_[u] + pull[u];
  }
}

const Status& Claims::status(const Quantity& quantity) const noexcept {
  switch (quantity.kind) {
    case Kind::term_gradient:
    case Kind::term_hessian:
      return term_status_[at(quantity.index)];
    case Kind::rows:
    case Kind::row_hessian:
      return group_status_[at(quantity.index)];
    default:
      return lagrangian_status_;
  }
}

Claim Claims::along(const Quantity& quantity, const std::vector<double>& direction) const {
  switch (quantity.kind) {
    case Kind::term_gradient:
      return scalar(term_gradient_[at(quantity.index)], term_hessian_[at(quantity.index)], direction);
    case Kind::term_hessian:
      return second(term_hessian_[at(quantity.index)], direction);
    case Kind::rows:
      return rows(quantity.index, direction);
    case Kind::row_hessian:
      return second(group_hessian_[at(quantity.index)], direction);
    case Kind::lagrangian_gradient:
      return scalar(lagrangian_gradient_, lagrangian_hessian_, direction);
    case Kind::lagrangian_hessian:
      break;
  }
  return second(lagrangian_hessian_, direction);
}

Claim Claims::scalar(const std::vector<double>& gradient, const std::vector<double>& hessian,
                     const std::vector<double>& direction) const {
  const SymmetricProduct product = symmetric_product(assembly_.hessian_pattern(), hessian, direction);
  double value = 0.0, squared = 0.0, second = 0.0;
  for (std::size_t u = 0; u < gradient.size(); ++u) {
    const double change = gradient[u] * direction[u];
    value += change;
    squared += change * change;
    second = std::hypot(second, product.size[u] * direction[u]);
  }
  Claim out{{value}, {std::sqrt(squared)}, {1.0}, {0}};
  out.least = least_displacement * second;
  return out;
}

Claim Claims::second(const std::vector<double>& hessian, const std::vector<double>& direction) const {
  SymmetricProduct product = symmetric_product(assembly_.hessian_pattern(), hessian, direction);
  return {std::move(product.value), std::move(product.size), steps_, field_of_};
}

Claim Claims::rows(int group, const std::vector<double>& direction) const {
  const RowOrigin& origin = assembly_.row_origins()[at(group)];
  const SymmetricProduct product = row_product(assembly_.jacobian_pattern(), jacobian_, direction);
  const auto slice = [&](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + origin.first, all.begin() + origin.first + origin.count);
  };
  Claim out{slice(product.value), slice(product.size), std::vector<double>(at(origin.count), 1.0),
            std::vector<int>(at(origin.count), 0)};
  double farthest = 0.0;
  for (const double number : direction) farthest = std::max(farthest, std::fabs(number));
  out.floor = row_floor;
  out.least = least_row * farthest;
  out.magnitude = largest_coordinate_;
  return out;
}

}  // namespace bowstring::checking
