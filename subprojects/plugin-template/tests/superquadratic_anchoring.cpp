#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "core/interfaces/energy.hpp"
#include "plugin_under_test.hpp"

namespace bowstring::testing {

namespace {

constexpr double stiffness = 0.7, slack = 1.5, reference = 2.0;

struct Anchoring {
  std::unique_ptr<Energy> energy;
  EnergyDeclaration declaration;

  Status declare(Extension extension) {
    CurveView curve;
    curve.name = "curve";
    curve.extension = extension;
    return energy->declare(curve, declaration);
  }
  const Law& law() const { return *declaration.laws.at(0); }
};

Anchoring anchoring(double exponent, int unit_alternative = 0) {
  ParameterSet parameters;
  add(parameters, "stiffness").unit_alternative = unit_alternative;
  add(parameters, "slack");
  add(parameters, "reference-displacement");
  add(parameters, "exponent").number = exponent;
  Anchoring out{make<Energy>(parameters), {}};
  REQUIRE(out.declare(Extension::stretching).ok());
  return out;
}

/// V and its derivatives at one place.
struct Reading {
  double energy = 0.0;
  std::vector<double> stress, modulus, parameter_energy, parameter_stress;
};

/// At the displacement u, with p = (k, u₀, d). State 1 is the origin, so that no displacement is too small to have.
Reading read(const Law& law, const std::vector<double>& u, const std::vector<double>& p) {
  const std::size_t n = u.size();
  const std::vector<double> origin(n, 0.0);
  Reading out;
  out.stress.resize(n);
  out.modulus.resize(static_cast<std::size_t>(packed_size(static_cast<int>(n))));
  out.parameter_energy.resize(p.size());
  out.parameter_stress.resize(n * p.size());
  std::vector<double> parameter_modulus(static_cast<std::size_t>(packed_size(static_cast<int>(p.size()))));
  const double* const parameter[] = {&p[0], &p[1], &p[2]};
  LawBatch batch;
  batch.count = 1;
  batch.dimension = static_cast<int>(n);
  batch.x = u.data();
  batch.reference = origin.data();
  batch.parameter = parameter;
  batch.energy = &out.energy;
  batch.stress = out.stress.data();
  batch.modulus = out.modulus.data();
  batch.parameter_energy = out.parameter_energy.data();
  batch.parameter_stress = out.parameter_stress.data();
  batch.parameter_modulus = parameter_modulus.data();
  const Status status = law.evaluate(batch);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

double largest(const Reading& reading) {
  double out = std::fabs(reading.energy);
  for (const auto* list : {&reading.stress, &reading.modulus, &reading.parameter_energy, &reading.parameter_stress}) {
    for (const double number : *list) out = std::isfinite(number) ? std::fmax(out, std::fabs(number)) : number;
  }
  return out;
}

/// Central difference of fourth order of f at 0.
double slope(const std::function<double(double)>& f) {
  const double h = 1e-3;
  return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
}

std::vector<double> moved(std::vector<double> x, std::size_t k, double h) {
  x[k] += h;
  return x;
}

void check_slope(double claimed, const std::function<double(double)>& f, double scale) {
  CHECK(std::fabs(claimed - slope(f)) <= 1e-8 * scale);
}

}  // namespace

TEST_CASE("the pull is the one of the formula") {
  // V = (k d²/m) e^m and V' = k d e^(m − 1) with e = (r − u0)/d; here r = 5.5 mm along (3, 4)/5 and e = 2.
  const std::vector<double> parameters = {stiffness, slack, reference};
  for (const double m : {2.5, 3.0, 4.0, 6.0}) {
    const Reading reading = read(anchoring(m).law(), {3.3, 4.4}, parameters);
    CHECK(reading.energy == doctest::Approx(0.7 * 4.0 / m * std::pow(2.0, m)).epsilon(1e-12));
    const double pull = 0.7 * 2.0 * std::pow(2.0, m - 1.0);
    CHECK(reading.stress[0] == doctest::Approx(0.6 * pull).epsilon(1e-12));
    CHECK(reading.stress[1] == doctest::Approx(0.8 * pull).epsilon(1e-12));
  }
}

TEST_CASE("every derivative against differences, in the plane and in space, with and without slack") {
  for (const double m : {2.5, 3.0, 4.0, 6.0}) {
    const Anchoring energy = anchoring(m);
    for (const double u0 : {0.0, slack}) {
      for (const std::vector<double>& u : {std::vector<double>{1.7, -0.9}, {-0.8, 1.9, 1.1}}) {
        const std::vector<double> p = {stiffness, u0, reference};
        const Reading exact = read(energy.law(), u, p);
        const double scale = largest(exact);
        REQUIRE(scale > 1e-3);
        const auto at = [&](std::size_t k, double h) { return read(energy.law(), moved(u, k, h), p); };
        const auto with = [&](std::size_t q, double h) { return read(energy.law(), u, moved(p, q, h)); };
        for (std::size_t k = 0; k < u.size(); ++k) {
          check_slope(
              exact.stress[k], [&](double h) { return at(k, h).energy; }, scale);
          for (std::size_t l = 0; l <= k; ++l) {
            const auto entry = static_cast<std::size_t>(packed_index(static_cast<int>(k), static_cast<int>(l)));
            check_slope(
                exact.modulus[entry], [&](double h) { return at(k, h).stress[l]; }, scale);
          }
        }
        for (std::size_t q = 0; q < p.size(); ++q) {
          if (p[q] == 0.0) continue;  // on its bound
          check_slope(
              exact.parameter_energy[q], [&](double h) { return with(q, h).energy; }, scale);
          for (std::size_t k = 0; k < u.size(); ++k) {
            check_slope(
                exact.parameter_stress[k * p.size() + q], [&](double h) { return with(q, h).stress[k]; }, scale);
          }
        }
      }
    }
  }
}

TEST_CASE("energy, pull and stiffness vanish within the slack and grow from zero beyond it") {
  for (const double m : {2.5, 3.0, 6.0}) {
    const Anchoring energy = anchoring(m);
    const std::vector<double> p = {stiffness, slack, reference};
    CHECK(largest(read(energy.law(), {0.0, 0.0, 0.0}, p)) == 0.0);
    CHECK(largest(read(energy.law(), {0.9, -0.8, 0.7}, p)) == 0.0);
    double before = largest(read(energy.law(), {0.0, slack + 1.0, 0.0}, p));
    REQUIRE(before > 0.1);
    for (double beyond = 1e-2; beyond > 1e-13; beyond *= 1e-2) {
      const double now = largest(read(energy.law(), {0.0, slack + beyond, 0.0}, p));
      CHECK(now > 0.0);
      // V'' falls like (r − u0)^(m − 2), a hundredth of the distance per step.
      CHECK(now < 0.2 * before);
      before = now;
    }
  }
}

TEST_CASE("without slack State 1 is a smooth minimum: no derivative is infinite there or near it") {
  for (const double m : {2.000001, 2.5, 3.0, 4.0, 6.0}) {
    const Anchoring energy = anchoring(m);
    for (const double r : {0.0, 1e-320, 1e-200, 1e-150, 1e-120, 1e-50, 1.1e-50, 1e-30, 1e-8}) {
      for (const double u0 : {0.0, 1e-320, 1e-60, 1e-50}) {
        const Reading reading = read(energy.law(), {r, 0.0, -r}, {stiffness, u0, reference});
        CHECK(std::isfinite(largest(reading)));
        CHECK(largest(reading) <= 3.0 * stiffness);
      }
    }
    const Reading at_state_1 = read(energy.law(), {0.0, 0.0, 0.0}, {stiffness, 0.0, reference});
    CHECK(largest(at_state_1) == 0.0);
  }
}

TEST_CASE("a position that is not a number is not mistaken for State 1") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(read(anchoring(4.0).law(), {nan, 0.0}, {stiffness, slack, reference}).energy));
}

TEST_CASE("the unit decides whether the law is per length or per node") {
  Anchoring per_length = anchoring(4.0, 0), per_node = anchoring(4.0, 1);
  CHECK(per_length.declaration.descriptions.at(0).weighing == Weighing::per_length);
  CHECK(per_node.declaration.descriptions.at(0).weighing == Weighing::per_place);
  CHECK(per_node.declare(Extension::sliding).ok());
  const Status status = per_length.declare(Extension::sliding);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text ==
        "superquadratic-anchoring per length on 'curve', whose length slides, would have to follow its material; put "
        "it on the vessel, give the wire a fixed length, or give the stiffness per node (N/mm)");
}

}  // namespace bowstring::testing
