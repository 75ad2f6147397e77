#include "core/transport/certificate.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace bowstring;

TEST_CASE("a certificate holds relative to mass and cost, and never where a number is none") {
  TransportCertificate good;
  good.cost_scale = 100.0;
  good.marginal_a = good.marginal_b = 1.9e-9;
  good.dual_violation = 0.9e-7;
  good.gap = -1.9e-7;
  CHECK(certificate_holds(good, 2.0));
  for (double TransportCertificate::*part : {&TransportCertificate::marginal_a, &TransportCertificate::marginal_b,
                                             &TransportCertificate::dual_violation, &TransportCertificate::gap}) {
    for (const double bad : {1e-3, HUGE_VAL, static_cast<double>(NAN)}) {
      TransportCertificate flawed = good;
      flawed.*part = bad;
      CHECK_FALSE(certificate_holds(flawed, 2.0));
    }
  }
  CHECK(certificate_holds(TransportAnswer{}, 1.0));
}
