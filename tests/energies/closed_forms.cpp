#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "plugins/sdk/templated_law.hpp"
#include "tests/energies/terms.hpp"

namespace bowstring::testing {

namespace {

LawDescription of(std::vector<std::string> parameters) {
  LawDescription description;
  description.parameters = std::move(parameters);
  return description;
}

/// First bending component: behind the twist where there is one.
template <class T>
std::size_t first_bending(const LawPoint<T>& place) {
  return place.x.size() == 3 ? 1 : 0;
}

template <class T>
T square(const T& number) {
  return number * number;
}

/// ½ EI |κ|²
struct Bending {
  LawDescription describe() const { return of({"bending-stiffness"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    T sum = 0.0;
    for (std::size_t k = first_bending(place); k < place.x.size(); ++k) sum += square(place.x[k]);
    return 0.5 * place.parameter[0] * sum;
  }
};

/// ½ (ω − ω⁰)ᵀ diag(GJ, EI, EI) (ω − ω⁰)
struct Strain {
  LawDescription describe() const { return of({"bending-stiffness", "torsional-stiffness"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    T out = 0.0;
    for (std::size_t k = 0; k < place.x.size(); ++k) {
      const bool twist = k < first_bending(place);
      out += 0.5 * place.parameter[twist ? 1 : 0] * square(place.x[k] - place.reference[k]);
    }
    return out;
  }
};

/// ½ EI (|κ| − |κ⁰|)²
struct Magnitude {
  LawDescription describe() const { return of({"bending-stiffness", "torsional-stiffness"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    using std::sqrt;
    T now = 0.0;
    double rest = 0.0;
    for (std::size_t k = first_bending(place); k < place.x.size(); ++k) {
      now += square(place.x[k]);
      rest += square(place.reference[k]);
    }
    return 0.5 * place.parameter[0] * square(sqrt(now) - std::sqrt(rest));
  }
};

/// ½ EA (λ − 1)²
struct Stretch {
  LawDescription describe() const { return of({"stretch-stiffness"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    return 0.5 * place.parameter[0] * square(place.x[0] - 1.0);
  }
};

/// ½ k |p − p⁰|²
struct Spring {
  LawDescription describe() const { return of({"stiffness"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    T sum = 0.0;
    for (std::size_t k = 0; k < place.x.size(); ++k) sum += square(place.x[k] - place.reference[k]);
    return 0.5 * place.parameter[0] * sum;
  }
};

/// T (L − chord)
struct Tension {
  double chord = 0.0;
  LawDescription describe() const { return of({"tension"}); }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    return place.parameter[0] * (place.x[0] - chord);
  }
};

enum class Strains { random, tiny, near_pi };

/// Places with what a law reads there.
struct Places {
  int count = 12, dimension = 1;
  std::vector<double> x, reference;
  std::vector<std::vector<double>> parameter;

  Places(int n, int parameter_count, Strains strains, bool straight, unsigned seed) : dimension(n) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> stiffness(0.5, 100.0);
    const double pi = std::acos(-1.0);
    for (int i = 0; i < count; ++i) {
      std::vector<double> direction(at(n));
      double squared = 0.0;
      for (double& number : direction) number = normal(random), squared += number * number;
      double size = std::sqrt(squared);
      if (strains == Strains::tiny) size = 1e-8;
      if (strains == Strains::near_pi) size = pi - std::pow(10.0, -1.0 - i);
      for (const double number : direction) {
        x.push_back(number / std::sqrt(squared) * size);
        reference.push_back(straight ? 0.0 : normal(random) * (strains == Strains::tiny ? 1e-8 : 0.5));
      }
    }
    for (int p = 0; p < parameter_count; ++p) {
      parameter.emplace_back();
      for (int i = 0; i < count; ++i) parameter.back().push_back(stiffness(random));
    }
  }
};

struct Outputs {
  std::vector<double> energy, stress, modulus;
};

Outputs evaluate(const Law& law, const Places& places, bool derivatives = true) {
  const int n = places.dimension;
  Outputs out;
  out.energy.assign(at(places.count), 1e300);
  out.stress.assign(at(places.count * n), 1e300);
  out.modulus.assign(at(places.count * packed_size(n)), 1e300);
  std::vector<const double*> parameter;
  for (const std::vector<double>& values : places.parameter) parameter.push_back(values.data());
  LawBatch batch;
  batch.count = places.count;
  batch.dimension = n;
  batch.x = places.x.data();
  batch.reference = places.reference.data();
  batch.parameter = parameter.data();
  batch.energy = out.energy.data();
  if (derivatives) {
    batch.stress = out.stress.data();
    batch.modulus = out.modulus.data();
  }
  const Status status = law.evaluate(batch);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

/// Every number of a place within 1e-12 of that place's largest.
void check_equal(const std::vector<double>& closed, const std::vector<double>& templated, int places) {
  REQUIRE(closed.size() == templated.size());
  REQUIRE(largest(templated) > 0.0);
  const std::size_t each = templated.size() / at(places);
  for (int i = 0; i < places; ++i) {
    double scale = 0.0, difference = 0.0;
    for (std::size_t k = at(i) * each; k < at(i + 1) * each; ++k) {
      scale = std::max(scale, std::fabs(templated[k]));
      difference = std::max(difference, std::fabs(closed[k] - templated[k]));
    }
    CAPTURE(i);
    CHECK(scale > 0.0);
    CHECK(difference <= 1e-12 * scale);
  }
}

/// A law as one of the plugins makes it, with the numbers that it may read at a place.
struct ClosedForm {
  std::string name;
  std::shared_ptr<Session> session;  ///< owns the law
  const Law* law = nullptr;
  int parameters = 1;
  std::vector<int> dimensions;
};

ClosedForm closed_form(const std::string& name, const SmallScene& scene, const std::string& label, std::size_t index,
                       std::vector<int> dimensions, const std::string& more = "") {
  ClosedForm out;
  out.name = name;
  std::string text = scene.text();
  text.insert(text.find("[solver]"), more);
  out.session = session_of_text(text);
  const EnergyUse& use = energy_of(*out.session, label);
  REQUIRE(index < use.laws.size());
  out.law = use.laws[index].law;
  out.parameters = static_cast<int>(use.laws[index].description.parameters.size());
  out.dimensions = std::move(dimensions);
  return out;
}

template <class Author>
void check_closed_form(const ClosedForm& form, Author author = Author()) {
  const TemplatedLaw<Author> templated(author);
  REQUIRE(templated.description().parameters.size() == at(form.parameters));
  for (const int n : form.dimensions) {
    for (const Strains strains : {Strains::random, Strains::tiny, Strains::near_pi}) {
      for (const bool straight : {false, true}) {
        CAPTURE(form.name);
        CAPTURE(n);
        CAPTURE(static_cast<int>(strains));
        CAPTURE(straight);
        const Places places(n, form.parameters, strains, straight, 17u + static_cast<unsigned>(n));
        const Outputs closed = evaluate(*form.law, places);
        const Outputs expected = evaluate(templated, places);
        check_equal(closed.energy, expected.energy, places.count);
        check_equal(closed.stress, expected.stress, places.count);
        if (form.name != "tension")
          check_equal(closed.modulus, expected.modulus, places.count);
        else
          CHECK(largest(closed.modulus) == 0.0);

        const Outputs alone = evaluate(*form.law, places, false);
        CHECK(alone.energy == closed.energy);
        CHECK(largest(alone.stress) == 1e300);
        CHECK(largest(alone.modulus) == 1e300);
      }
    }
  }
}

SmallScene in_space() {
  SmallScene scene;
  scene.dimension = 3;
  return scene;
}

}  // namespace

TEST_CASE("wire-bending is ½ EI |κ|² of the bending components, in one, two and three numbers") {
  check_closed_form<Bending>(closed_form("bending", in_space(), "wire-bending", 0, {1, 2, 3}));
  check_closed_form<Bending>(closed_form("bending in the plane", SmallScene(), "wire-bending", 0, {1}));
}

TEST_CASE("vessel-strain is ½ Δωᵀ diag(GJ, EI, EI) Δω in the plane and with material frames") {
  check_closed_form<Strain>(closed_form("plane", SmallScene(), "vessel-strain", 0, {1}));
  SmallScene frames = in_space();
  frames.vessel_frames = true;
  check_closed_form<Strain>(closed_form("frames", frames, "vessel-strain", 0, {3}));
}

TEST_CASE("vessel-strain without torsion in space is ½ EI (|κ| − |κ⁰|)²") {
  check_closed_form<Magnitude>(closed_form("magnitude", in_space(), "vessel-strain", 0, {2, 3}));
}

TEST_CASE("vessel-strain without torsion has no derivative at κ = 0 and takes zero stress there, EI where κ⁰ = 0 too") {
  const ClosedForm form = closed_form("magnitude", in_space(), "vessel-strain", 0, {2});
  Places places(2, 2, Strains::random, false, 3);
  places.x.assign(places.x.size(), 0.0);
  const Outputs curved = evaluate(*form.law, places);
  REQUIRE(largest(curved.energy) > 1e-3);
  CHECK(largest(curved.stress) == 0.0);
  for (const bool straight : {false, true}) {
    if (straight) places.reference.assign(places.reference.size(), 0.0);
    const Outputs out = evaluate(*form.law, places);
    CHECK(largest(out.stress) == 0.0);
    for (const double number : out.modulus) CHECK(std::isfinite(number));
    for (int i = 0; straight && i < places.count; ++i) {
      CHECK(out.modulus[at(3 * i)] == places.parameter[0][at(i)]);
      CHECK(out.modulus[at(3 * i + 1)] == 0.0);
      CHECK(out.modulus[at(3 * i + 2)] == places.parameter[0][at(i)]);
    }
  }
}

TEST_CASE("vessel-strain's stretch is ½ EA (λ − 1)²") {
  check_closed_form<Stretch>(closed_form("stretch in the plane", SmallScene(), "vessel-strain", 1, {1}));
  check_closed_form<Stretch>(closed_form("stretch in space", in_space(), "vessel-strain", 1, {1}));
}

TEST_CASE("anchoring and extravascular are ½ k |p − p⁰|² in the plane and in space") {
  const std::string extravascular =
      "[[energy]]\ntype = \"extravascular\"\non = \"vessel\"\nstiffness = \"0.04 N/mm\"\n";
  for (const char* name : {"anchoring", "extravascular"}) {
    check_closed_form<Spring>(closed_form(name, SmallScene(), name, 0, {2}, extravascular));
    check_closed_form<Spring>(closed_form(name, in_space(), name, 0, {3}, extravascular));
  }
}

TEST_CASE("axial-tension is T (L − chord) with the chord of the wire's ends") {
  const ClosedForm form = closed_form("tension", in_space(), "axial-tension", 0, {1});
  const Curve& wire = *form.session->scene->find("wire");
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double difference = wire.start[at(3 * (wire.view.nodes - 1) + k)] - wire.start[at(k)];
    squared += difference * difference;
  }
  REQUIRE(squared > 1.0);
  check_closed_form(form, Tension{std::sqrt(squared)});
}

TEST_CASE("the laws read their parameters in the order that they describe") {
  const auto names = [](const Session& session, const std::string& label, std::size_t law) {
    return energy_of(session, label).laws[law].description.parameters;
  };
  const auto session = session_of(in_space());
  using Names = std::vector<std::string>;
  CHECK(names(*session, "wire-bending", 0) == Names{"bending-stiffness"});
  CHECK(names(*session, "vessel-strain", 0) == Names{"bending-stiffness", "torsional-stiffness"});
  CHECK(names(*session, "vessel-strain", 1) == Names{"stretch-stiffness"});
  CHECK(names(*session, "anchoring", 0) == Names{"stiffness"});
  CHECK(names(*session, "axial-tension", 0) == Names{"tension"});
}

}  // namespace bowstring::testing
