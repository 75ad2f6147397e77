#pragma once

#include <string>
#include <vector>

#include "core/check/comparison.hpp"
#include "core/check/probe.hpp"

namespace bowstring::checking {

/// One derivative that somebody claims.
struct Quantity {
  enum class Kind : int { term_gradient, term_hessian, rows, row_hessian, lagrangian_gradient, lagrangian_hessian };
  Kind kind = Kind::term_gradient;
  int index = 0;  ///< of the term or of the group of rows
  std::string subject, what;

  bool second_order() const noexcept {
    return kind == Kind::term_hessian || kind == Kind::row_hessian || kind == Kind::lagrangian_hessian;
  }
  bool reads_rows() const noexcept { return kind != Kind::term_gradient && kind != Kind::term_hessian; }
  bool reads_energies() const noexcept { return kind != Kind::rows && kind != Kind::row_hessian; }
};

/// Every derivative of the scene, each first one followed by its second one.
std::vector<Quantity> quantities(const Assembly& assembly);

/// The function whose derivative a quantity is; null where the probe has none.
const std::vector<double>* sample(const Quantity& quantity, const Probe& probe) noexcept;

/// What plugins and kernel claim at one state, with the multipliers of the probes.
class Claims {
 public:
  Claims(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& multipliers);

  /// Why a quantity could not be had.
  const Status& status(const Quantity& quantity) const noexcept;
  Claim along(const Quantity& quantity, const std::vector<double>& direction) const;
  /// Of one term, n.
  const std::vector<double>& term_gradient(int term) const noexcept {
    return term_gradient_[static_cast<std::size_t>(term)];
  }

 private:
  void claim_terms(const std::vector<double>& q);
  void claim_rows(const std::vector<double>& q, const std::vector<double>& multipliers);
  Claim scalar(const std::vector<double>& gradient, const std::vector<double>& hessian,
               const std::vector<double>& direction) const;
  Claim second(const std::vector<double>& hessian, const std::vector<double>& direction) const;
  Claim rows(int group, const std::vector<double>& direction) const;

  Assembly& assembly_;
  std::vector<double> steps_;  // n: natural sizes of the unknowns
  std::vector<int> field_of_;  // n
  double largest_coordinate_ = 0.0;
  std::vector<Status> term_status_, group_status_;
  Status lagrangian_status_;
  std::vector<std::vector<double>> term_gradient_, term_hessian_, group_hessian_;
  std::vector<double> jacobian_, lagrangian_gradient_, lagrangian_hessian_;
};

}  // namespace bowstring::checking
