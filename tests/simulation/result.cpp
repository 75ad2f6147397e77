#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/curve/temporary_file.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

const SimulationResult& solved() {
  static const SimulationResult result = small_planar().solve(plugins());
  REQUIRE_MESSAGE(result.converged(), result.reason());
  return result;
}

std::string content(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("numbers are read by the paths of the result document") {
  const Found<double> peak = solved().number("quantities.peak_displacement_mm");
  REQUIRE(peak.ok());
  CHECK(peak.value > 1.0);
  const NumberTable state_1 = solved().numbers("curves.iliac.reference_points").value;
  const NumberTable state_2 = solved().numbers("curves.iliac.points").value;
  REQUIRE(state_2.rows == 24);
  REQUIRE(state_2.columns == 2);
  REQUIRE(state_2.values.size() == 48);
  double largest = 0.0;
  for (int i = 0; i < state_2.rows; ++i) {
    largest = std::max(largest, std::hypot(state_2(i, 0) - state_1(i, 0), state_2(i, 1) - state_1(i, 1)));
  }
  CHECK(largest == doctest::Approx(peak.value).epsilon(1e-14));
  CHECK(solved().numbers("curves.iliac.points.3").value.values == std::vector<double>{state_2(3, 0), state_2(3, 1)});
  CHECK(solved().number("curves.1.points.3.1").value == solved().number("curves.lunderquist.points.3.1").value);
  // A key with a dot in it.
  CHECK(solved().number("state.fields.lunderquist.length.0").value ==
        doctest::Approx(solved().number("quantities.wire_length_mm").value).epsilon(1e-12));
}

TEST_CASE("a key behind a list reads it of every entry") {
  const NumberTable forces = solved().numbers("contacts.force_N").value;
  const NumberTable directions = solved().numbers("contacts.direction").value;
  REQUIRE(forces.rows == 22);
  CHECK(forces.columns == 1);
  CHECK(directions.rows == forces.rows);
  CHECK(directions.columns == 2);
  double sum = 0.0;
  for (const double force : forces.values) sum += force;
  CHECK(sum > 1.0);
  CHECK(sum == doctest::Approx(solved().number("quantities.contact_force_N").value));
  CHECK(forces(5) == solved().number("contacts.5.force_N").value);
  CHECK(solved().numbers("solver.history.energy").value.rows ==
        static_cast<int>(solved().number("solver.iterations").value) + 1);
  CHECK(solved().numbers("supports.force_N").value.columns == 2);
}

TEST_CASE("text and names") {
  CHECK(solved().text("status").value == "converged");
  CHECK(solved().text("contacts.0.vessel").value == "iliac");
  CHECK(solved().names("curves").value == std::vector<std::string>{"iliac", "lunderquist"});
  CHECK(solved().names("composition.energy").value ==
        std::vector<std::string>{"wire-bending", "vessel-strain", "anchoring", "axial-tension"});
  CHECK(solved().names("energy").value.back() == "total");
  CHECK(solved().names("supports").value == std::vector<std::string>{"0", "1", "2", "3"});
  CHECK(solved().names("").value.front() == "format");
}

TEST_CASE("lists without entries and null entries") {
  CHECK(solved().numbers("equilibria.force_N").ok());
  const Found<NumberTable> none = solved().numbers("certificate.weakly_active");
  CHECK(none.ok());
  CHECK(none.value.rows == 0);
  const NumberTable twist = solved().numbers("curves.twist_per_mm").value;  // null in the plane
  REQUIRE(twist.values.size() == 2);
  CHECK(std::isnan(twist(0)));
  CHECK(std::isnan(twist(1)));
}

TEST_CASE("a path that leads nowhere says what there is") {
  CHECK(solved().number("quantities.peak_displacment_mm").error ==
        "path 'quantities.peak_displacment_mm': no 'peak_displacment_mm' in 'quantities', which is a table; expected "
        "one of: peak_displacement_mm, mean_displacement_mm, mean_displacement_nodes_mm, wire_length_mm, "
        "vessel_length_change_mm, arc_to_chord, contact_count, contact_force_N, line_load_peak_N_per_mm, "
        "line_load_integral_N; did you mean 'peak_displacement_mm'?");
  CHECK(solved().numbers("curves.iliak.points").error ==
        "path 'curves.iliak.points': no 'iliak' in 'curves', which is a list of 2; expected one of: iliac, "
        "lunderquist, or a number from 0 to 1; did you mean 'iliac'?");
  CHECK(solved().numbers("contacts.force").error ==
        "path 'contacts.force': no 'force' in 'contacts', which is a list of 22; expected one of: wire, vessel, row, "
        "wire_edge, t, s_mm, vessel_s_mm, gap_mm, force_N, direction, or a number from 0 to 21; did you mean "
        "'force_N'?");
  CHECK(solved().number("contacts.22.force_N").error ==
        "path 'contacts.22.force_N': no '22' in 'contacts', which is a list of 22; expected one of: wire, vessel, "
        "row, wire_edge, t, s_mm, vessel_s_mm, gap_mm, force_N, direction, or a number from 0 to 21");
  CHECK(contains(solved().number("quantities..x").error, "no '' in 'quantities'"));
  CHECK(contains(solved().text("status.x").error, "no 'x' in 'status', which is text"));
}

TEST_CASE("a value of another kind says which") {
  CHECK(solved().number("certificate.leftmost_mode").error ==
        "path 'certificate.leftmost_mode' leads to null: not known, or not defined in this scene; expected a number");
  CHECK(std::isnan(solved().number("certificate.leftmost_mode").value));
  CHECK(solved().numbers("curves.iliac.twist_per_mm").error ==
        "path 'curves.iliac.twist_per_mm' leads to null: not known, or not defined in this scene; expected numbers");
  CHECK(solved().number("contacts.force_N").error ==
        "path 'contacts.force_N' leads to 22 values, one of every entry of a list; expected one: name the entry, or "
        "number it from 0");
  CHECK(solved().number("curves.iliac.points").error ==
        "path 'curves.iliac.points' leads to a list of 24; expected a number");
  CHECK(solved().numbers("contacts").error ==
        "path 'contacts' leads to a table; expected numbers, or rows of equally many numbers, in row 0");
  CHECK(solved().text("energy.total").error == "path 'energy.total' leads to a number; expected text");
  CHECK(solved().names("status").error == "path 'status' leads to text; expected a table or a list");
}

TEST_CASE("the document is written whole, and never over what the composition reads") {
  const TemporaryFile composition("schema = 1\nbase = \"" + scene_file("planar-iliac-smooth.toml") + "\"\n");
  const std::string folder = std::filesystem::path(composition.path()).parent_path().string();
  Simulation simulation = Simulation::from_file(composition.path());
  simulation.set("vessel.iliac.geometry.nodes", 24);
  const SimulationResult result = simulation.solve(plugins());
  REQUIRE_MESSAGE(result.ok(), result.refusal().text());
  const std::string file = folder + "/result.json";
  REQUIRE(result.write(file).ok());
  CHECK(content(file) == result.json());
  std::filesystem::create_symlink("result.json", folder + "/link.json");
  REQUIRE(solved().write(folder + "/link.json").ok());
  CHECK(std::filesystem::is_symlink(folder + "/link.json"));
  CHECK(content(file) == solved().json());

  const std::string before = content(composition.path());
  const Status refused = result.write(composition.path());
  CHECK(refused.code == Code::invalid_input);
  CHECK(composition.anonymous(refused.text) ==
        "cannot write 'F': it is what the composition reads; expected another file");
  CHECK(content(composition.path()) == before);
  CHECK(result.write("/dev/null").text == "cannot write '/dev/null': it is no regular file");
  CHECK(result.write(folder + "/no/result.json").text ==
        "cannot write '" + folder + "/no/result.json': No such file or directory");
  CHECK_FALSE(result.write("").ok());
  const auto count = std::distance(std::filesystem::directory_iterator(folder), {});
  CHECK(count == 3);
}

}  // namespace bowstring
