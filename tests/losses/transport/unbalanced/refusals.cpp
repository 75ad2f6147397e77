#include <doctest/doctest.h>

#include <cmath>

#include "core/transport/one_sided.hpp"
#include "tests/losses/transport/unbalanced/problems.hpp"

using namespace bowstring;
using namespace bowstring::testing;

TEST_CASE("settings that are missing or do not go together are told") {
  CHECK(refusal_of("unbalanced", {}).find("marginal-weight") != std::string::npos);
  CHECK(refusal_of("unbalanced", {{"marginal-weight", "0.0"}}).find("marginal-weight") != std::string::npos);
  CHECK(refusal_of("unbalanced", {{"marginal-weight", "1.0"}, {"epsilon", "-1.0"}}).find("epsilon") !=
        std::string::npos);
  CHECK(refusal_of("unbalanced", {{"marginal-weight", "1.0"}, {"penalty", "tv"}}).find("total-variation") !=
        std::string::npos);
  const std::string both =
      refusal_of("unbalanced", {{"marginal-weight", "1.0"}, {"penalty", "total-variation"}, {"epsilon", "0.1"}});
  CHECK(both.find("leave epsilon out") != std::string::npos);
}

TEST_CASE("negative costs: KL takes them, total variation says why not") {
  TransportComparison smooth = unbalanced("kl", 1.0), linear = unbalanced("total-variation", 1.0);
  const std::vector<double> one = {1.0};
  CHECK(compare(smooth, one, one, {-1.0}).value == doctest::Approx(2.0 - 2.0 * std::exp(0.5)).epsilon(1e-13));
  TransportResult out;
  const Status status = linear.compare(one, one, std::vector<double>{-1.0}, out);
  CHECK(status.code == Code::invalid_input);
  CHECK(status.text.find("row 0, column 0 is negative") != std::string::npos);
}

TEST_CASE("weights that are flawed are refused; sums that differ are not") {
  TransportComparison transport = unbalanced("kl", 1.0);
  TransportResult out;
  const std::vector<double> cost = {0.0, 1.0};
  CHECK(transport.compare(std::vector<double>{1.0}, std::vector<double>{3.0, 4.0}, cost, out).ok());
  for (const std::vector<double>& weights : {std::vector<double>{0.0, 0.0}, {-1.0, 2.0}, {std::nan(""), 1.0}}) {
    CHECK(transport.compare(std::vector<double>{1.0}, weights, cost, out).code == Code::invalid_input);
  }
}

TEST_CASE("one-sided derivatives are of plans with fixed sums") {
  std::mt19937 random(1);
  const Measure a = random_cloud(random, 3), b = random_cloud(random, 4);
  TransportComparison transport = unbalanced("total-variation", 1.0);
  const TransportResult at = compare(transport, a, b);
  const std::vector<double> motion_a(18, 1.0), motion_b(24, 0.0);
  OneSidedDerivatives out;
  const Status status = one_sided_derivatives(transport, a, b, at, motion_a, motion_b, out);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text.find("lets mass go") != std::string::npos);
}
