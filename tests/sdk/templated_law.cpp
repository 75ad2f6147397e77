#include "plugins/sdk/templated_law.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

namespace bowstring {

namespace {

/// W = ½ EI (|κ − κ⁰|² + β |κ|⁴) + √EI β: every second derivative in x and p is at work.
struct Stiffening {
  LawDescription describe() const {
    LawDescription description;
    description.parameters = {"bending-stiffness", "stiffening"};
    return description;
  }

  template <class T>
  T energy(const LawPoint<T>& place) const {
    using std::sqrt;
    T squared = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < place.x.size(); ++k) {
      squared += place.x[k] * place.x[k];
      const T d = place.x[k] - place.reference[k];
      difference += d * d;
    }
    const T& ei = place.parameter[0];
    const T& beta = place.parameter[1];
    return 0.5 * ei * (difference + beta * squared * squared) + sqrt(ei) * beta;
  }
};

struct Greedy {
  LawDescription describe() const {
    LawDescription description;
    description.parameters.resize(17);
    return description;
  }
  template <class T>
  T energy(const LawPoint<T>&) const {
    return 0.0;
  }
};

struct Outputs {
  std::vector<double> energy, stress, modulus, parameter_energy, parameter_stress, parameter_modulus;
};

struct Case {
  int count = 5, dimension = 1;
  std::vector<double> x, reference, stiffness, stiffening;

  Case(int n, unsigned seed) : dimension(n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> between(0.2, 1.2);
    for (int i = 0; i < count * n; ++i) {
      x.push_back(between(random));
      reference.push_back(between(random));
    }
    for (int i = 0; i < count; ++i) {
      stiffness.push_back(between(random));
      stiffening.push_back(between(random));
    }
  }

  Outputs evaluate(const Law& law, bool all) const {
    const auto sized = [&](int each) { return std::vector<double>(static_cast<std::size_t>(count * each)); };
    const int n = dimension;
    Outputs out{sized(1), sized(n), sized(packed_size(n)), sized(2), sized(2 * n), sized(3)};
    const double* parameter[] = {stiffness.data(), stiffening.data()};
    LawBatch batch;
    batch.count = count;
    batch.dimension = n;
    batch.x = x.data();
    batch.reference = reference.data();
    batch.parameter = parameter;
    batch.energy = out.energy.data();
    if (all) {
      batch.stress = out.stress.data();
      batch.modulus = out.modulus.data();
      batch.parameter_energy = out.parameter_energy.data();
      batch.parameter_stress = out.parameter_stress.data();
      batch.parameter_modulus = out.parameter_modulus.data();
    }
    REQUIRE(law.evaluate(batch).ok());
    return out;
  }
};

/// (a − b)/2h for each entry against `expected`, whose entries of one place begin every `stride` at `offset`.
void check_slope(const std::vector<double>& plus, const std::vector<double>& minus, double h,
                 const std::vector<double>& expected, std::size_t each, std::size_t stride,
                 const std::vector<std::size_t>& offset) {
  double norm = 0.0;
  for (std::size_t i = 0; i < plus.size() / each; ++i) {
    for (std::size_t k = 0; k < each; ++k) {
      const double slope = (plus[i * each + k] - minus[i * each + k]) / (2.0 * h);
      CHECK(expected[i * stride + offset[k]] == doctest::Approx(slope).epsilon(1e-7));
      norm += std::fabs(slope);
    }
  }
  REQUIRE(norm > 1e-3);
}

}  // namespace

TEST_CASE("every derivative of a templated law against differences") {
  const TemplatedLaw<Stiffening> law;
  const double h = 1e-5;
  for (int n = 1; n <= 3; ++n) {
    CAPTURE(n);
    const Case at(n, 3);
    const Outputs exact = at.evaluate(law, true);
    CHECK(exact.energy == at.evaluate(law, false).energy);

    for (int k = 0; k < n; ++k) {
      Case plus = at, minus = at;
      for (int i = 0; i < at.count; ++i) {
        plus.x[static_cast<std::size_t>(i * n + k)] += h;
        minus.x[static_cast<std::size_t>(i * n + k)] -= h;
      }
      const Outputs up = plus.evaluate(law, true), down = minus.evaluate(law, true);
      const auto size = static_cast<std::size_t>(n);
      const auto row = static_cast<std::size_t>(k);
      check_slope(up.energy, down.energy, h, exact.stress, 1, size, {row});
      std::vector<std::size_t> entries;
      for (int l = 0; l < n; ++l) {
        entries.push_back(static_cast<std::size_t>(k >= l ? packed_index(k, l) : packed_index(l, k)));
      }
      check_slope(up.stress, down.stress, h, exact.modulus, size, static_cast<std::size_t>(packed_size(n)), entries);
      check_slope(up.parameter_energy, down.parameter_energy, h, exact.parameter_stress, 2, 2 * size,
                  {2 * row, 2 * row + 1});
    }
    for (const std::size_t p : {std::size_t{0}, std::size_t{1}}) {
      Case plus = at, minus = at;
      for (double& value : p == 0 ? plus.stiffness : plus.stiffening) value += h;
      for (double& value : p == 0 ? minus.stiffness : minus.stiffening) value -= h;
      const Outputs up = plus.evaluate(law, true), down = minus.evaluate(law, true);
      check_slope(up.energy, down.energy, h, exact.parameter_energy, 1, 2, {p});
      check_slope(up.parameter_energy, down.parameter_energy, h, exact.parameter_modulus, 2, 3, {p, p + 1});
    }
  }
}

TEST_CASE("a templated law says what it cannot take") {
  const TemplatedLaw<Stiffening> law;
  LawBatch batch;
  batch.dimension = 4;
  const Status status = law.evaluate(batch);
  CHECK(status.code == Code::unsupported);
  CHECK(status.text == "a templated law reads 1 to 3 numbers, this place has 4");
  CHECK_THROWS_WITH_AS(TemplatedLaw<Greedy>(), "a templated law takes at most 16 parameters, this one describes 17",
                       StatusError);
}

}  // namespace bowstring
