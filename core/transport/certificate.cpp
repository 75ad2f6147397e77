#include "core/transport/certificate.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring {

// Written so that a number which is none fails.
bool certificate_holds(const TransportCertificate& certificate, double mass) noexcept {
  const double marginal = std::max(std::fabs(certificate.marginal_a), std::fabs(certificate.marginal_b));
  const double cost = certificate_tolerance * certificate.cost_scale;
  return marginal <= certificate_tolerance * mass &&
         std::fabs(certificate.marginal_b) <= certificate_tolerance * mass && certificate.dual_violation <= cost &&
         std::fabs(certificate.gap) <= cost * mass;
}

bool certificate_holds(const TransportAnswer& answer, double mass) noexcept {
  return !answer.certified || certificate_holds(answer.certificate, mass);
}

}  // namespace bowstring
