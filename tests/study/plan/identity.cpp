#include <doctest/doctest.h>

#include <set>

#include "tests/study/plan/small_study.hpp"

namespace bowstring {

using testing::SmallStudy;

namespace {

constexpr const char* axes = R"([axes]
A = { path = "energy.wire-bending.bending-stiffness", values = ["1 N mm^2", "2 N mm^2", "0.001 N m^2"] }
)";

std::vector<std::string> hashes(SmallStudy& study) {
  std::vector<std::string> out;
  for (const study::PlannedRun& run : study.plan().runs) out.push_back(run.hash);
  return out;
}

std::string with_points(const std::string& third) {
  SmallStudy study(R"([axes]
A = { path = "wire.rod.geometry", values = [{ type = "csv", file = "points.csv" }] }
)");
  study.folder().write("points.csv", "x_mm,y_mm,z_mm\n0,0,0\n50,0,0\n" + third + "\n");
  return hashes(study).front();
}

}  // namespace

TEST_CASE("a run is told apart by its composition, wherever it stands") {
  SmallStudy one(axes), other(axes);
  const std::vector<std::string> first = hashes(one);
  CHECK(first == hashes(other));
  CHECK(std::set<std::string>(first.begin(), first.end()).size() == 3);
  CHECK(first[0].size() == 64);
  SmallStudy stricter(std::string("[set]\n\"solver.tolerance\" = 1e-9\n") + axes);
  CHECK(hashes(stricter)[0] != first[0]);
}

TEST_CASE("and by what its files of data hold, not by their place") {
  CHECK(with_points("100,0,0") == with_points("100,0,0"));
  CHECK(with_points("100,0,0") != with_points("101,0,0"));
}

TEST_CASE("and, in a warm chain, by all runs before it") {
  SmallStudy cold(axes), warm(std::string("warm-along = \"A\"\n") + axes);
  CHECK(hashes(cold)[0] == hashes(warm)[0]);
  CHECK(hashes(cold)[1] != hashes(warm)[1]);
  SmallStudy longer(R"(warm-along = "A"
[axes]
A = { path = "energy.wire-bending.bending-stiffness", values = ["5 N mm^2", "2 N mm^2", "0.001 N m^2"] }
)");
  CHECK(hashes(longer)[2] != hashes(warm)[2]);
}

TEST_CASE("later states count with the files and plugins that they alone name") {
  const auto hash_with = [](const std::string& points) {
    SmallStudy study(std::string("quantities = [\"energy.total\"]\n") + axes,
                     "schema = 1\nbase = \"steps.toml\"\n");
    study.folder().write("points.csv", "x_mm,y_mm,z_mm\n0,0,0\n50,0,0\n" + points + "\n");
    study.folder().write("steps.toml", R"(schema = 1
base = "rod.toml"
[[step]]
name = "straight"
[[step]]
name = "other solver"
"solver.type" = "active-set"
"wire.rod.geometry" = { type = "csv", file = "points.csv" }
)");
    const study::Plan plan = study.plan();
    CHECK(plan.libraries.count("solver/active-set") == 1);
    return plan.runs.front().hash;
  };
  CHECK(hash_with("100,0,0") == hash_with("100,0,0"));
  CHECK(hash_with("100,0,0") != hash_with("101,0,0"));
}

}  // namespace bowstring
