#pragma once

#include "core/interfaces/transport.hpp"

namespace bowstring {

/// What a certificate may be off, relative to the mass, to the largest cost, and to both, and still hold.
inline constexpr double certificate_tolerance = 1e-9;

/// Whether marginals, dual feasibility and gap hold to the tolerance. `mass`: the sum of the weights of one measure.
bool certificate_holds(const TransportCertificate& certificate, double mass) noexcept;

/// Of an answer of measures with this mass: true where there is no certificate.
bool certificate_holds(const TransportAnswer& answer, double mass) noexcept;

}  // namespace bowstring
