#include <doctest/doctest.h>

#include <cmath>

#include "study/plan/references.hpp"
#include "study/results/references.hpp"
#include "tests/study/plan/small_study.hpp"

namespace bowstring {

using testing::SmallStudy;

namespace {

constexpr const char* axes = R"([axes]
K = { path = "solver.type", values = ["interior-point", "active-set"] }
N = { path = "wire.rod.geometry.nodes", values = [10, 20, 40] }
)";

/// Values 1 + 3 N^-2 + 10 K, as if every run had converged but those in `failed`.
study::StudyData data_of(const study::Plan& plan, const std::vector<std::size_t>& failed = {}) {
  study::StudyData data;
  for (const study::Axis& axis : plan.study.axes) data.axes.push_back(axis.data);
  data.quantities.resize(1);
  for (const study::PlannedRun& run : plan.runs) {
    study::RunData one;
    one.choice = run.choice;
    one.status = "converged";
    data.runs.push_back(one);
    const double mesh = data.axes[1].number[static_cast<std::size_t>(run.choice[1])];
    data.quantities[0].value.push_back(1.0 + 3.0 / (mesh * mesh) + 10.0 * run.choice[0]);
  }
  for (const std::size_t r : failed) data.runs[r].status = "stalled";
  study::add_references(plan, data);
  return data;
}

study::Plan plan_with(const std::string& reference) {
  return SmallStudy("quantities = [\"energy.total\"]\n" + std::string(axes) + "[reference]\n" + reference).plan();
}

}  // namespace

TEST_CASE("the finest mesh, of each formulation or of one for all") {
  study::StudyData data = data_of(plan_with("finest = \"N\"\n"));
  for (std::size_t r = 0; r < 6; ++r) CHECK(data.quantities[0].reference[r] == data.quantities[0].value[r < 3 ? 2 : 5]);
  CHECK(data.quantities[0].reference_text == "the run with N = 40");
  data = data_of(plan_with("finest = \"N\"\nat = { K = \"active-set\" }\n"));
  for (std::size_t r = 0; r < 6; ++r) CHECK(data.quantities[0].reference[r] == data.quantities[0].value[5]);
  CHECK(data.quantities[0].reference_text == "the run with N = 40, K = active-set");
}

TEST_CASE("a finest run that did not converge is no reference") {
  const study::StudyData data = data_of(plan_with("finest = \"N\"\n"), {2});
  CHECK(std::isnan(data.quantities[0].reference[0]));
  CHECK(data.quantities[0].reference[3] == data.quantities[0].value[5]);
}

TEST_CASE("extrapolation over the meshes") {
  const study::StudyData data = data_of(plan_with("richardson = \"N\"\n"));
  for (std::size_t r = 0; r < 6; ++r) {
    CHECK(data.quantities[0].reference[r] == doctest::Approx(r < 3 ? 1.0 : 11.0).epsilon(1e-9));
  }
  CHECK(std::isnan(data_of(plan_with("richardson = \"N\"\n"), {1}).quantities[0].reference[0]));
}

TEST_CASE("stored values and closed forms") {
  CHECK(data_of(plan_with("stored = { energy_total_N_mm = 7 }\n")).quantities[0].reference[4] == 7.0);
  const study::StudyData data = data_of(plan_with("closed-form = { \"energy.total\" = \"1 + sqrt(N) * _pi\" }\n"));
  CHECK(data.quantities[0].reference[2] == doctest::Approx(1.0 + std::sqrt(40.0) * std::acos(-1.0)).epsilon(1e-12));
  CHECK(data.quantities[0].reference_text == "a closed form");
}

}  // namespace bowstring
