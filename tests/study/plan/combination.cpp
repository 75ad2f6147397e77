#include <doctest/doctest.h>

#include "tests/study/plan/small_study.hpp"

namespace bowstring {

using testing::SmallStudy;
using Texts = std::vector<std::string>;

TEST_CASE("axes are crossed, the last one fastest, in the order of the file") {
  SmallStudy study(R"([axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
A = { path = "energy.wire-bending.bending-stiffness", linear = ["1 N mm^2", "3 N mm^2"], count = 3 }
)");
  CHECK(study.runs() ==
        Texts{"10/1 N mm^2", "10/2 N mm^2", "10/3 N mm^2", "20/1 N mm^2", "20/2 N mm^2", "20/3 N mm^2"});
  const study::Plan plan = study.plan();
  CHECK(plan.study.along == 0);
  CHECK(plan.study.axes[1].data.column == "A_N_mm2");
  CHECK(plan.units.size() == 6);
}

TEST_CASE("zipped axes go together") {
  const std::string axes = R"([axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
T = { path = "wire.rod.geometry.length", values = ["1 mm", "2 mm"] }
K = { path = "solver.type", values = ["interior-point", "active-set"] }
)";
  CHECK(SmallStudy("zipped = [[\"N\", \"T\"]]\n" + axes).runs() ==
        Texts{"10/1 mm/interior-point", "10/1 mm/active-set", "20/2 mm/interior-point", "20/2 mm/active-set"});
  CHECK(SmallStudy("combine = \"zipped\"\n" + axes).runs() == Texts{"10/1 mm/interior-point", "20/2 mm/active-set"});
}

TEST_CASE("one at a time: the first values, then each axis' others") {
  SmallStudy study(R"(combine = "one-at-a-time"
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
K = { path = "solver.type", values = ["interior-point", "active-set", "trust-region"] }
)");
  CHECK(study.runs() == Texts{"10/interior-point", "20/interior-point", "10/active-set", "10/trust-region"});
}

TEST_CASE("exclusions leave out what fits all of them") {
  SmallStudy study(R"(exclude = [{ N = 20, K = ["active-set", "trust-region"] }, { N = 10, K = "trust-region" }]
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
K = { path = "solver.type", values = ["interior-point", "active-set", "trust-region"] }
)");
  CHECK(study.runs() == Texts{"10/interior-point", "10/active-set", "20/interior-point"});
}

TEST_CASE("alternatives swap blocks, and bases whole compositions") {
  SmallStudy study(R"([axes]
how = { alternatives = { plain = {}, "no load" = { "energy.point-load" = { type = "dead-moment", on = "rod", moment = "1 N mm", at = "last" }, "solver.tolerance" = 1e-9 } } }
scene = { base = { short = "rod.toml", other = "rod.toml" } }
)",
                   "schema = 1\n");
  CHECK(study.runs() == Texts{"plain/short", "plain/other", "no load/short", "no load/other"});
  const study::Plan plan = study.plan();
  CHECK(plan.study.axes[0].data.paths == Texts{"energy.point-load", "solver.tolerance"});
  CHECK(plan.runs[0].hash == plan.runs[1].hash);  // one composition by two names
  CHECK(plan.runs[0].hash != plan.runs[2].hash);
  CHECK(!plan.study.axes[0].data.has_cases());
  CHECK(!plan.study.axes[1].data.has_cases());  // one file twice
}

TEST_CASE("other compositions, and axes that are named as cases, state other problems") {
  SmallStudy study(R"(cases = ["K"]
[axes]
scene = { base = { one = "rod.toml", other = "rod2.toml" } }
K = { path = "solver.type", values = ["interior-point", "active-set"] }
)",
                   "schema = 1\n");
  study.folder().write("rod2.toml", "schema = 1\nbase = \"rod.toml\"\n");
  const study::Plan plan = study.plan();
  CHECK(plan.study.axes[0].data.has_cases());
  CHECK(!plan.study.axes[0].data.same_problem(0, 1));
  CHECK(plan.study.axes[1].data.problem == std::vector<int>{0, 1});
}

TEST_CASE("a logarithmic range has equal ratios and its own ends") {
  SmallStudy study(R"([axes]
A = { path = "energy.wire-bending.bending-stiffness", log = ["1 N mm^2", "100 N mm^2"], count = 3 }
N = { path = "wire.rod.geometry.nodes", log = [10, 40], count = 3 }
)");
  CHECK(study.runs().front() == "1 N mm^2/10");
  CHECK(study.runs()[4] == "10 N mm^2/20");
  CHECK(study.runs().back() == "100 N mm^2/40");
  CHECK(study.plan().study.axes[1].data.spacing == study::Spacing::logarithmic);
}

TEST_CASE("a warm chain is one unit, and its runs follow from each other") {
  SmallStudy study(R"(warm-along = "A"
[axes]
A = { path = "energy.wire-bending.bending-stiffness", values = ["1 N mm^2", "2 N mm^2", "3 N mm^2"] }
K = { path = "solver.type", values = ["interior-point", "active-set"] }
)");
  const study::Plan plan = study.plan();
  REQUIRE(plan.units.size() == 2);
  CHECK(plan.units[0].runs == std::vector<int>{0, 2, 4});
  CHECK(plan.units[1].runs == std::vector<int>{1, 3, 5});
  CHECK(plan.runs[0].predecessor == -1);
  CHECK(plan.runs[4].predecessor == 2);
}

TEST_CASE("what only some combinations cannot take is a refused run with its reason") {
  SmallStudy study(R"([axes]
rule = { path = "enforcement", values = [{ type = "kkt" }, { type = "penalty", weight = "1 N/mm" }] }
W = { alternatives = { "as it is" = {}, heavy = { "enforcement.weight" = "10 N/mm" } } }
)");
  const study::Plan plan = study.plan();
  REQUIRE(plan.runs.size() == 4);
  CHECK(plan.units.size() == 3);
  CHECK(plan.runs[1].hash == "");
  CHECK(plan.runs[1].refusal.rfind("unknown key 'weight' in enforcement 'kkt'", 0) == 0);
  CHECK(plan.runs[3].refusal == "");
}

TEST_CASE("the reduced form says its axes anew") {
  SmallStudy study(R"(repeats = 3
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20, 40] }
K = { path = "solver.type", values = ["interior-point", "active-set"] }
[reduced]
repeats = 1
[reduced.axes]
N = { path = "wire.rod.geometry.nodes", values = [10] }
)");
  CHECK(study.plan().runs.size() == 6);
  CHECK(study.plan().study.repeats == 3);
  CHECK(study.plan(true).runs.size() == 2);
  CHECK(study.plan(true).study.repeats == 1);
}

TEST_CASE("columns of quantities have their units") {
  SmallStudy study(
      R"(quantities = ["energy.wire-bending", "certificate.stationarity", { path = "curves.rod.curvature_per_mm", reduce = "max" }, { path = "contacts.force_N", reduce = "count" }]
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10] }
)");
  std::string columns;
  for (const study::QuantityOfInterest& quantity : study.plan().study.quantities) columns += quantity.column + " ";
  CHECK(columns == "energy_wire_bending_N_mm stationarity_N curvature_max_per_mm force_count ");
}

}  // namespace bowstring
