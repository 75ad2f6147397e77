#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/assembly/law_batch.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// W = ½ a |x − x⁰|² + b (x₁ + 2x₂ + 3x₃)³ + c x₁, which has every derivative.
class CubicLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    const int n = batch.dimension;
    for (int i = 0; i < batch.count; ++i) {
      const double a = batch.parameter[0][i], b = batch.parameter[1][i];
      const double* x = batch.x + i * n;
      const double* rest = batch.reference + i * n;
      double squared = 0.0, sum = 0.0;
      for (int k = 0; k < n; ++k) squared += (x[k] - rest[k]) * (x[k] - rest[k]), sum += (k + 1) * x[k];
      if (batch.energy != nullptr) batch.energy[i] = 0.5 * a * squared + b * sum * sum * sum + 0.3 * x[0];
      for (int k = 0; k < n; ++k) {
        if (batch.stress != nullptr) {
          batch.stress[i * n + k] = a * (x[k] - rest[k]) + 3.0 * b * sum * sum * (k + 1) + (k == 0 ? 0.3 : 0.0);
        }
        for (int l = 0; l <= k && batch.modulus != nullptr; ++l) {
          batch.modulus[i * packed_size(n) + packed_index(k, l)] =
              (k == l ? a : 0.0) + 6.0 * b * sum * (k + 1) * (l + 1);
        }
      }
    }
    return {};
  }
};

class NotFiniteLaw final : public Law {
 public:
  Status evaluate(const LawBatch& batch) const noexcept override {
    for (int i = 0; i < batch.count; ++i) {
      if (batch.energy != nullptr) batch.energy[i] = 0.0;
      if (batch.stress != nullptr) batch.stress[i] = i == 2 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
      if (batch.modulus != nullptr) batch.modulus[i] = 1.0;
    }
    return {};
  }
};

constexpr int places = 5;

/// One site whose y are given, without a kinematics.
struct LoneSite {
  Curve curve;
  SiteDeclaration declaration;
  SiteTable table;
  std::vector<double> reference;

  LoneSite(Site site, int dimension, bool varying) {
    declaration.site = site;
    declaration.count = places;
    declaration.values = dimension + (varying ? 2 : 0);
    declaration.lengths_vary = varying;
    declaration.width = 1;
    declaration.stencil.assign(places, 0);
    for (int i = 0; i < places; ++i) declaration.ds.push_back(1.5 + 0.25 * i), declaration.arc.push_back(2.0 * i);
    table = make_site_table(curve, declaration);
    table.modulus.assign(at(places * packed_size(declaration.values)), 0.0);
    fill(table.y, 61);
    reference = table.y;
    fill(reference, 62);
  }

  void fill(std::vector<double>& y, unsigned seed) const {
    const std::vector<double> numbers = random_numbers(static_cast<int>(y.size()), seed);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const bool length =
          declaration.lengths_vary && static_cast<int>(k) % declaration.values >= declaration.values - 2;
      y[k] = length ? 2.0 + 0.5 * numbers[k] : numbers[k];
    }
  }
};

struct Answer {
  double energy = 0.0;
  std::vector<double> stress, modulus;
};

Answer ask(LoneSite& site, LawAssembly& law) {
  Answer out;
  std::fill(site.table.stress.begin(), site.table.stress.end(), 0.0);
  std::fill(site.table.modulus.begin(), site.table.modulus.end(), 0.0);
  REQUIRE(law.evaluate(site.table, &out.energy).ok());
  REQUIRE(law.add_modulus(site.table).ok());
  out.stress = site.table.stress;
  out.modulus = site.table.modulus;
  return out;
}

void check_chain_rule(LoneSite& site, LawAssembly& law) {
  constexpr double h = 1e-4;
  const int v = site.declaration.values;
  const Answer claimed = ask(site, law);
  REQUIRE(std::fabs(claimed.energy) > 1e-3);
  REQUIRE(largest(claimed.stress) > 1e-3);
  REQUIRE(largest(claimed.modulus) > 1e-3);
  const auto at_step = [&](int k, double step) {
    const double kept = site.table.y[at(k)];
    site.table.y[at(k)] = kept + step;
    Answer out = ask(site, law);
    site.table.y[at(k)] = kept;
    return out;
  };
  for (int k = 0; k < places * v; ++k) {
    const Answer a = at_step(k, -2 * h), b = at_step(k, -h), c = at_step(k, h), d = at_step(k, 2 * h);
    const auto slope = [&](double fa, double fb, double fc, double fd) {
      return (fa - fd + 8.0 * (fc - fb)) / (12.0 * h);
    };
    CHECK(claimed.stress[at(k)] == doctest::Approx(slope(a.energy, b.energy, c.energy, d.energy)).epsilon(1e-8));
    const int place = k / v;
    for (int l = 0; l < v; ++l) {
      const auto i = at(place * v + l);
      const double expected = slope(a.stress[i], b.stress[i], c.stress[i], d.stress[i]);
      const int row = std::max(k % v, l), column = std::min(k % v, l);
      CHECK(std::fabs(claimed.modulus[at(place * packed_size(v) + packed_index(row, column))] - expected) <= 1e-8);
    }
  }
}

LawUse cubic_use(const CubicLaw& law, Site site, Weighing weighing, int count) {
  LawUse use;
  use.law = &law;
  use.description.site = site;
  use.description.weighing = weighing;
  use.description.parameters = {"a", "b"};
  use.parameters.assign(2, std::vector<double>(at(count)));
  for (int i = 0; i < count; ++i) {
    use.parameters[0][at(i)] = 1.0 + 0.2 * i;
    use.parameters[1][at(i)] = 0.1 - 0.05 * i;
  }
  return use;
}

}  // namespace

TEST_CASE("a law's chain rule is that of differences in y, fixed and varying lengths, per length and per place") {
  const CubicLaw law;
  for (const Site kind : {Site::station, Site::edge, Site::node, Site::length}) {
    for (const Weighing weighing : {Weighing::per_length, Weighing::per_place}) {
      for (const bool varying : {false, true}) {
        if (varying && kind != Site::station && kind != Site::edge) continue;
        for (const int dimension : {1, 2, 3}) {
          CAPTURE(static_cast<int>(kind));
          CAPTURE(static_cast<int>(weighing));
          CAPTURE(varying);
          CAPTURE(dimension);
          LoneSite site(kind, dimension, varying);
          const LawUse use = cubic_use(law, kind, weighing, places);
          LawAssembly assembly(use, site.table, site.reference);
          check_chain_rule(site, assembly);
        }
      }
    }
  }
}

TEST_CASE("energies per length are weighed by the length of material, those per place are not") {
  const CubicLaw law;
  LoneSite site(Site::node, 2, false);
  const LawUse per_length = cubic_use(law, Site::node, Weighing::per_length, places);
  const LawUse per_place = cubic_use(law, Site::node, Weighing::per_place, places);
  LawAssembly dense(per_length, site.table, site.reference), lumped(per_place, site.table, site.reference);
  const std::vector<double> by_length = ask(site, dense).stress, by_place = ask(site, lumped).stress;
  REQUIRE(largest(by_place) > 1e-3);
  for (int k = 0; k < 2 * places; ++k) {
    CHECK(by_length[at(k)] == doctest::Approx(site.declaration.ds[at(k / 2)] * by_place[at(k)]).epsilon(1e-14));
  }
}

TEST_CASE("a law acts on the places that it names, each with its weight") {
  const CubicLaw law;
  LoneSite site(Site::station, 2, true);
  LawUse use = cubic_use(law, Site::station, Weighing::per_length, 2);
  use.description.places = {3, 1};
  LawAssembly plain(use, site.table, site.reference);
  const Answer whole = ask(site, plain);
  use.description.weight = {0.25, 0.25};
  LawAssembly quarter(use, site.table, site.reference);
  const Answer part = ask(site, quarter);
  REQUIRE(std::fabs(whole.energy) > 1e-3);
  CHECK(part.energy == doctest::Approx(0.25 * whole.energy).epsilon(1e-14));
  for (int k = 0; k < places * site.declaration.values; ++k) {
    const int place = k / site.declaration.values;
    CHECK(part.stress[at(k)] == doctest::Approx(0.25 * whole.stress[at(k)]).epsilon(1e-14));
    if (place != 1 && place != 3) CHECK(whole.stress[at(k)] == 0.0);
  }
  CHECK(largest_difference(part.modulus, whole.modulus) > 0.0);
  use.description.weight = {0.75, -1.5};
  LawAssembly uneven(use, site.table, site.reference);
  check_chain_rule(site, uneven);
}

TEST_CASE("a law that answers no finite number is named with its place") {
  const NotFiniteLaw law;
  LoneSite site(Site::station, 1, false);
  LawUse use;
  use.law = &law;
  LawAssembly assembly(use, site.table, site.reference);
  double energy = 0.0;
  const Status status = assembly.evaluate(site.table, &energy);
  CHECK(status.code == Code::failed);
  CHECK(status.text == "its stress is not a finite number at station 2");
  use.description.places = {4, 0, 1};
  use.description.site = Site::edge;
  LawAssembly chosen(use, site.table, site.reference);
  CHECK(chosen.evaluate(site.table, &energy).text == "its stress is not a finite number at edge 1");
}

}  // namespace bowstring::testing
