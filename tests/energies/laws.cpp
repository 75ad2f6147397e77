#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plugins/sdk/templated_law.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr int places = 6;
constexpr double tolerance = 1e-12;  // relative to the largest entry

/// ½ a Σ (x − x⁰)², over bending components alone where `first` says so.
struct Quadratic {
  std::vector<int> parameter;  ///< of each component
  bool from_rest = true;
  double rest = 0.0;

  LawDescription describe() const {
    LawDescription out;
    out.parameters = {"a", "b"};
    return out;
  }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    T sum = 0.0;
    for (std::size_t k = 0; k < place.x.size(); ++k) {
      if (parameter[k] < 0) continue;
      const T difference = place.x[k] - (from_rest ? place.reference[k] : rest);
      sum += 0.5 * place.parameter[at(parameter[k])] * difference * difference;
    }
    return sum;
  }
};

/// ½ a (|κ| − |κ⁰|)² over the components from `first` on.
struct Magnitude {
  int first = 0;

  LawDescription describe() const {
    LawDescription out;
    out.parameters = {"a", "b"};
    return out;
  }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    using std::sqrt;
    T squared = 0.0;
    double rest = 0.0;
    for (std::size_t k = at(first); k < place.x.size(); ++k) {
      squared += place.x[k] * place.x[k];
      rest += place.reference[k] * place.reference[k];
    }
    const T difference = sqrt(squared) - std::sqrt(rest);
    return 0.5 * place.parameter[0] * difference * difference;
  }
};

struct Linear {
  double origin = 0.0;
  LawDescription describe() const {
    LawDescription out;
    out.parameters = {"a", "b"};
    return out;
  }
  template <class T>
  T energy(const LawPoint<T>& place) const {
    return place.parameter[0] * (place.x[0] - origin);
  }
};

struct Answer {
  std::vector<double> energy, stress, modulus;
};

struct State {
  std::vector<double> x, reference;
};

State state(int dimension, double amplitude, unsigned seed) {
  State out{random_numbers(places * dimension, seed), random_numbers(places * dimension, seed + 1)};
  for (double& number : out.x) number *= amplitude;
  for (double& number : out.reference) number *= amplitude;
  return out;
}

Answer ask(const Law& law, int dimension, const State& at_state) {
  const std::vector<double> a = {65.0, 10.0, 1.0, 200.0, 4857.0, 0.3}, b = {40.0, 8.0, 0.0, 133.0, 190.0, 2.0};
  const double* const parameters[] = {a.data(), b.data()};
  Answer out;
  out.energy.assign(places, 0.0);
  out.stress.assign(at(places * dimension), 0.0);
  out.modulus.assign(at(places * packed_size(dimension)), 0.0);
  LawBatch batch;
  batch.count = places;
  batch.dimension = dimension;
  batch.x = at_state.x.data();
  batch.reference = at_state.reference.data();
  batch.parameter = parameters;
  batch.energy = out.energy.data();
  batch.stress = out.stress.data();
  batch.modulus = out.modulus.data();
  const Status status = law.evaluate(batch);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

void check_close(const std::vector<double>& a, const std::vector<double>& b, const char* what) {
  CAPTURE(what);
  CHECK(largest_difference(a, b) <= tolerance * largest(b));
}

/// Against the same density with all derivatives by automatic differentiation.
template <class Reference>
void check_law(const Law& law, const Reference& reference, int dimension, bool linear = false) {
  const TemplatedLaw<Reference> automatic(reference);
  unsigned seed = 7;
  for (const double amplitude : {0.3, 1e-8, 3.1}) {
    CAPTURE(dimension);
    CAPTURE(amplitude);
    const State at_state = state(dimension, amplitude, seed += 10);
    const Answer own = ask(law, dimension, at_state), expected = ask(automatic, dimension, at_state);
    REQUIRE(largest(expected.energy) > 0.0);
    REQUIRE(largest(expected.stress) > 0.0);
    if (!linear) REQUIRE(largest(expected.modulus) > 0.0);
    check_close(own.energy, expected.energy, "energy");
    check_close(own.stress, expected.stress, "stress");
    check_close(own.modulus, expected.modulus, "modulus");
  }
}

/// Law `index` of the energy with this label.
const Law& law_of(const Session& session, const std::string& label, std::size_t index = 0) {
  for (const EnergyUse& use : session.scene->energies) {
    if (use.label == label) return *use.laws.at(index).law;
  }
  REQUIRE_MESSAGE(false, "no energy " << label);
  std::abort();
}

SmallScene spatial(bool frames) {
  SmallScene scene;
  scene.dimension = 3;
  scene.vessel_frames = frames;
  return scene;
}

}  // namespace

TEST_CASE("wire-bending is its density, with one, two and three strain components") {
  const auto session = session_of(SmallScene{});
  const Law& law = law_of(*session, "wire-bending");
  check_law(law, Quadratic{{0}, false, 0.0}, 1);
  check_law(law, Quadratic{{0, 0}, false, 0.0}, 2);
  check_law(law, Quadratic{{-1, 0, 0}, false, 0.0}, 3);
}

TEST_CASE("vessel-strain is its density: planar bending, the strain vector, the magnitude of the curvature, stretch") {
  const auto plane = session_of(SmallScene{}), frames = session_of(spatial(true)), magnitude = session_of(spatial(false));
  check_law(law_of(*plane, "vessel-strain"), Quadratic{{0}, true, 0.0}, 1);
  check_law(law_of(*frames, "vessel-strain"), Quadratic{{1, 0, 0}, true, 0.0}, 3);
  check_law(law_of(*magnitude, "vessel-strain"), Magnitude{0}, 2);
  check_law(law_of(*magnitude, "vessel-strain"), Magnitude{1}, 3);
  check_law(law_of(*plane, "vessel-strain", 1), Quadratic{{0}, false, 1.0}, 1);
}

TEST_CASE("anchoring is its density, in the plane and in space") {
  const auto session = session_of(SmallScene{});
  check_law(law_of(*session, "anchoring"), Quadratic{{0, 0}, true, 0.0}, 2);
  check_law(law_of(*session, "anchoring"), Quadratic{{0, 0, 0}, true, 0.0}, 3);
}

TEST_CASE("axial-tension is the work of a dead load on the length beyond the chord") {
  const auto session = session_of(SmallScene{});
  check_law(law_of(*session, "axial-tension"), Linear{40.0}, 1, true);
}

TEST_CASE("a straight State 1 leaves the magnitude law smooth at zero curvature") {
  const auto session = session_of(spatial(false));
  const State zero{std::vector<double>(2 * places, 0.0), std::vector<double>(2 * places, 0.0)};
  const Answer own = ask(law_of(*session, "vessel-strain"), 2, zero);
  CHECK(largest(own.stress) == 0.0);
  CHECK(own.modulus[0] == 65.0);
  CHECK(own.modulus[1] == 0.0);
  CHECK(own.modulus[2] == 65.0);
}

TEST_CASE("a foundation's unit decides: per length it is weighed by the node's share of the curve, per node it is not") {
  for (const char* label : {"anchoring", "extravascular"}) {
    CAPTURE(label);
    std::string text = SmallScene{}.text();
    text.replace(text.find("\"anchoring\""), 11, '"' + std::string(label) + '"');
    const auto per_length = session_of_text(text);
    text.replace(text.find("0.05 N/mm^2"), 11, "0.25 N/mm");
    const auto per_node = session_of_text(text);
    const std::vector<double> q = moved_start(*per_length, 0.5, 3);
    const Curve& vessel = *per_length->scene->find("vessel");
    double length_sum = 0.0, node_sum = 0.0, shares = 0.0;
    for (int i = 0; i < vessel.view.nodes; ++i) {
      double squared = 0.0;
      for (int k = 0; k < 2; ++k) {
        const double u = q[at(vessel.coordinate_begin + 2 * i + k)] - vessel.reference[at(2 * i + k)];
        squared += u * u;
      }
      const double share = 0.5 * ((i > 0 ? vessel.edge_length[at(i - 1)] : 0.0) +
                                  (i + 1 < vessel.view.nodes ? vessel.edge_length[at(i)] : 0.0));
      length_sum += 0.5 * 0.05 * share * squared;
      node_sum += 0.5 * 0.25 * squared;
      shares += share;
    }
    CHECK(shares == doctest::Approx(vessel.arc.back()).epsilon(1e-12));
    const auto energy = [&](const Session& session) {
      std::vector<double> terms;
      REQUIRE(session.assembly->term_energies(q, terms).ok());
      return terms[2];
    };
    REQUIRE(length_sum > 0.0);
    CHECK(energy(*per_length) == doctest::Approx(length_sum).epsilon(1e-12));
    CHECK(energy(*per_node) == doctest::Approx(node_sum).epsilon(1e-12));
  }
}

TEST_CASE("vessel-strain warns where nothing resists stretching, and in space where nothing resists torsion") {
  SmallScene scene;
  const auto warnings = [](const std::string& text) {
    std::string all;
    const auto session = session_of_text(text);
    for (const std::string& warning : session->scene->warnings) all += warning + "\n";
    return all;
  };
  std::string text = scene.text();
  CHECK(warnings(text).find("stretch-stiffness is 0") == std::string::npos);
  text.erase(text.find("stretch-stiffness"), std::string("stretch-stiffness = \"11 N\"\n").size());
  CHECK(warnings(text).find("stretch-stiffness is 0") != std::string::npos);
  CHECK(warnings(text).find("torsional-stiffness is 0") == std::string::npos);
  CHECK(warnings(spatial(false).text()).find("torsional-stiffness is 0") != std::string::npos);
  CHECK(warnings(spatial(true).text()).find("torsional-stiffness is 0") == std::string::npos);
}

}  // namespace bowstring::testing
