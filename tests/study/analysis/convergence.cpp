#include "study/analysis/convergence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

namespace {

using namespace bowstring::study;
using doctest::Approx;

const std::vector<double> doublings{20, 40, 80, 160, 320, 640};

Sequence sequence(const std::vector<double>& n, const std::function<double(double)>& f) {
  Sequence out;
  out.resolution = n;
  for (double x : n) out.value.push_back(f(x));
  return out;
}

TEST_CASE("a pure order is found from its own differences, at uneven refinement too") {
  for (const std::vector<double>& n : {doublings, std::vector<double>{20, 30, 50, 80, 200}}) {
    for (double order : {1.0, 2.0, 3.0}) {
      const Fit fit = fit_convergence(sequence(n, [&](double x) { return 5.0 - 70.0 * std::pow(x, -order); }), 0.01);
      CHECK(fit.verdict == Settling::converges);
      CHECK(fit.order == Approx(order).epsilon(1e-6));
      CHECK(fit.limit == Approx(5.0).epsilon(1e-8));
      CHECK(fit.text == "order " + std::to_string(static_cast<int>(order)) + ".00 ± 0.00");
    }
  }
}

TEST_CASE("the converging series of the planar case has order 2") {
  Sequence series;
  series.resolution = doublings;
  series.value = {9.4765, 9.6848, 9.7341, 9.7461, 9.7492, 9.7499};
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(fit.order_low < 2.05);
  CHECK(fit.order_high > 2.0);
  CHECK(fit.order == Approx(2.03).epsilon(0.02));
  CHECK(fit.limit == Approx(9.7501).epsilon(1e-5));
  CHECK(fit.text == "order 2.04 ± 0.05");
}

TEST_CASE("the published refinement does not settle") {
  Sequence series;
  series.resolution = {40, 60, 80, 120, 160};
  series.value = {13.10, 11.30, 9.97, 8.10, 6.89};
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::does_not_settle);
  CHECK(fit.order < 0.5);
  CHECK(fit.text == "moves by 31 % with every doubling");
}

TEST_CASE("errors with noise have the order within its interval") {
  const double noise[6] = {1.1, 0.93, 1.05, 0.9, 1.08, 0.97};
  int k = 0;
  Sequence series = sequence(doublings, [&](double x) { return 2.0 + noise[k++] * 40.0 / (x * x); });
  series.reference = 2.0;
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(std::isnan(fit.beside));
  CHECK(fit.order_low < 2.0);
  CHECK(fit.order_high > 2.0);
  CHECK(fit.order_high - fit.order_low > 0.02);
  CHECK(fit.order_high - fit.order_low < 0.4);
}

TEST_CASE("a least-squares order and its interval are those of a straight line through the logarithms") {
  Sequence series = sequence({10, 20, 40}, [](double) { return 0.0; });
  series.value = {1.0 + 0.4, 1.0 + 0.1, 1.0 + 0.024};
  series.reference = 1.0;
  const Fit fit = fit_convergence(series, 0.5);
  REQUIRE(fit.verdict == Settling::converges);
  const double slope = std::log(0.4 / 0.024) / std::log(4.0), bend = std::log(0.1 * 0.1 / (0.4 * 0.024));
  CHECK(fit.order == Approx(slope));
  const double residual = std::sqrt(bend * bend / 6.0);  // of (1, −2, 1)/√6, one degree of freedom
  CHECK(0.5 * (fit.order_high - fit.order_low) ==
        Approx(12.7062 * residual / (std::log(2.0) * std::sqrt(2.0))).epsilon(1e-4));
}

TEST_CASE("what settles beside the reference is told so, with its own order") {
  Sequence series = sequence(doublings, [](double x) { return 10.03 + 60.0 / (x * x); });
  series.reference = 10.0;
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(fit.beside == Approx(0.003));
  CHECK(fit.text == "settles, order 2.00 ± 0.00, 0.3 % beside the reference");
  series.reference = 0.0;
  CHECK(fit_convergence(series, 0.01).text == "settles, order 2.00 ± 0.00, 10 beside the reference");
}

TEST_CASE("a reference that is the finest value biases no order") {
  Sequence series = sequence(doublings, [](double x) { return 10.0 + 60.0 / (x * x); });
  series.reference = series.value.back();
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.order == Approx(2.0).epsilon(1e-6));
  CHECK(std::isnan(fit.beside));
}

TEST_CASE("a reference that is a little off biases no order") {
  Sequence series = sequence(doublings, [](double x) { return 10.0 + 60.0 / (x * x); });
  series.reference = 10.0 - 30.0 / (640.0 * 640.0);
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(std::isnan(fit.beside));
  CHECK(fit.order == Approx(2.0).epsilon(0.01));
}

TEST_CASE("differences at the level of the solver are left out") {
  const double noise[8] = {0, 0, 0, 0, 0, 3e-9, -2e-9, 4e-9};
  const std::vector<double> n{20, 40, 80, 160, 320, 640, 1280, 2560};
  int k = 0;
  const Fit fit =
      fit_convergence(sequence(n, [&](double x) { return 1.0 + 1e3 * std::pow(x, -4.0) + noise[k++]; }), 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(fit.order == Approx(4.0).epsilon(0.02));
}

TEST_CASE("coarse meshes on which differences still grow are left out") {
  Sequence series = sequence({10, 20, 40, 80, 160, 320}, [](double x) { return 4.0 - 200.0 / (x * x); });
  series.value[0] = series.value[1] - 0.01;  // so that the first difference is small
  const Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(fit.order == Approx(2.0).epsilon(1e-6));
}

TEST_CASE("a drift under a converging part, a scatter and growth do not settle") {
  const Fit drift =
      fit_convergence(sequence(doublings, [](double x) { return 5.0 + 20.0 / (x * x) + 0.05 * std::log2(x); }), 0.01);
  CHECK(drift.verdict == Settling::does_not_settle);
  CHECK(drift.text == "moves by 0.92 % with every doubling");
  Sequence scatter = sequence(doublings, [](double) { return 0.0; });
  scatter.value = {1.0, 1.1, 0.95, 1.0, 1.04, 0.99};
  CHECK(fit_convergence(scatter, 0.01).text == "scatters by 4.8 %");
  const Fit growth = fit_convergence(sequence(doublings, [](double x) { return x; }), 0.01);
  CHECK(growth.verdict == Settling::does_not_settle);
  CHECK(growth.text == "moves by 100 % with every doubling");
}

TEST_CASE("a noisy sequence whose differences clearly fall settles") {
  Sequence series = sequence(doublings, [](double) { return 0.0; });
  series.value = {9.0, 9.5, 9.7, 9.74, 9.755, 9.758};
  CHECK(fit_convergence(series, 0.01).verdict == Settling::converges);
}

TEST_CASE("values that no mesh changes") {
  Sequence series = sequence(doublings, [](double) { return 3.0; });
  CHECK(fit_convergence(series, 0.01).text == "the same on every mesh");
  series.reference = 3.0;
  Fit fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::exact);
  CHECK(fit.text == "exact on every mesh");
  series.reference = 2.999;
  fit = fit_convergence(series, 0.01);
  CHECK(fit.verdict == Settling::converges);
  CHECK(fit.text == "the same on every mesh, 0.033 % beside the reference");
  CHECK(fit_convergence(sequence(doublings, [](double) { return 0.0; }), 0.01).verdict == Settling::exact);
}

TEST_CASE("too few values, and failures, are counted") {
  Sequence series = sequence({20, 40}, [](double x) { return x; });
  CHECK(fit_convergence(series, 0.01).text == "too few: 2 of 2 runs converged, 3 are needed");
  series.failures = 4;
  CHECK(fit_convergence(series, 0.01).verdict == Settling::too_few);
  CHECK(fit_convergence(series, 0.01).text == "too few: 2 of 6 runs converged, 3 are needed");
  CHECK(fit_convergence(Sequence{}, 0.01).verdict == Settling::too_few);
  Sequence three = sequence({20, 40, 80}, [](double x) { return 1.0 + 1.0 / x; });
  three.failures = 3;
  CHECK(fit_convergence(three, 0.01).text == "order 1.0; 3 of 6 runs failed");
}

TEST_CASE("names of verdicts") {
  CHECK(std::string(settling_name(Settling::converges)) == "converges");
  CHECK(std::string(settling_name(Settling::does_not_settle)) == "does not settle");
  CHECK(std::string(settling_name(Settling::exact)) == "exact");
  CHECK(std::string(settling_name(Settling::too_few)) == "too few");
}

}  // namespace
