#include <doctest/doctest.h>

#include "tests/study/plan/small_study.hpp"

namespace bowstring {

using testing::SmallStudy;

TEST_CASE("an axis path that does not exist, and a value that the schema refuses, at their places") {
  SmallStudy study(R"([axes]
T = { path = "energy.point-laod.at", values = ["last"] }
A = { path = "energy.wire-bending.bending-stiffness", values = ["1 N mm^2", "-1 N mm^2", "1 N"] }
)");
  CHECK(
      study.errors() ==
      "study.toml:4:48: path 'energy.point-laod.at': no entry 'point-laod' in 'energy'; expected one of: "
      "wire-bending, point-load; did you mean 'point-load'?\n"
      "study.toml:5:77: 'bending-stiffness' of energy 'wire-bending' is -1 N mm^2, out of bounds; expected at least 0 "
      "N mm^2; write a larger number\n"
      "study.toml:5:90: wrong unit: 'bending-stiffness' of energy 'wire-bending' is text \"1 N\"; expected a quantity "
      "in N mm^2, at least 0; write \"1 N mm^2\"");
}

TEST_CASE("all that is wrong with a file is told at once, values of compositions among it") {
  SmallStudy study(R"(warm-along = "Z"
repeats = 0
combine = "crosswise"
exclude = [{ N = 30 }]
[axes]
E = { path = "energy.wire-bending.bending-stiffness", values = [] }
N = { path = "wire.rod.geometry.nodes", values = [10, 20, 2] }
M = { path = "wire.rod.geometry.nodes", linear = [10, 20], count = 1 }
F = { values = [1], log = [1, 2] }
G = { path = "solver.tolerance", log = [0, 1e-9], count = 3 }
[reference]
finest = "Q"
)");
  CHECK(
      study.errors() ==
      "study.toml:3:14: 'warm-along' names the axis 'Z', which there is not; expected one of: N; name an axis of this "
      "study\n"
      "study.toml:4:11: 'repeats' is whole number 0; expected a whole number from 1 to 1000; write repeats = 1\n"
      "study.toml:5:11: 'combine' is text \"crosswise\"; expected one of: crossed, zipped, one-at-a-time; leave it out "
      "for all combinations\n"
      "study.toml:6:18: 'exclude' has whole number 30, which is no value of axis 'N'; expected one of: 10, 20, 2; name "
      "a value of the axis\n"
      "study.toml:8:64: 'values' of axis 'E' is an empty list; expected a list of values; write values = [first, "
      "second]\n"
      "study.toml:10:68: 'count' of axis 'M' is whole number 1; expected a whole number from 2 to 1000000; write count "
      "= "
      "5\n"
      "study.toml:11:21: axis 'F' has both 'values' and 'log'; expected one of: values, linear, log, alternatives, "
      "base, sobol, latin-hypercube; leave one of them\n"
      "study.toml:12:44: a logarithmic scale of axis 'G' from 0 to 1e-09; expected two values of one sign, neither of "
      "them 0; leave out scale = \"log\"\n"
      "study.toml:14:10: [reference] names the axis 'Q', which there is not; expected one of: N; name an axis of this "
      "study\n"
      "study.toml:9:59: 'nodes' of geometry 'line' of wire 'rod' is 2, out of bounds; expected at least 3 and at most "
      "1e+06; write a "
      "larger number");
}

TEST_CASE("two axes that set the same path, or one the whole of what the other sets a part of") {
  SmallStudy study(R"([axes]
A = { path = "solver.tolerance", values = [1e-8, 1e-9] }
B = { path = "solver.tolerance", values = [1e-7] }
C = { path = "solver", values = [{ type = "active-set" }] }
)");
  CHECK(study.errors() ==
        "study.toml:5:1: axes 'A' and 'B' both set 'solver.tolerance'; expected one axis for each path; leave one of "
        "them, or zip their values into one\n"
        "study.toml:6:1: axes 'A' and 'C' both set 'solver', the second one undoing 'solver.tolerance'; expected one "
        "axis for each path; write 'C' first\n"
        "study.toml:6:1: axes 'B' and 'C' both set 'solver', the second one undoing 'solver.tolerance'; expected one "
        "axis for each path; write 'C' first");
}

TEST_CASE("a reference that no run reaches") {
  SmallStudy study(R"(exclude = [{ K = "active-set" }]
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
K = { path = "solver.type", values = ["interior-point", "active-set"] }
[reference]
finest = "N"
at = { K = "active-set" }
)");
  CHECK(study.errors() ==
        "study.toml:7:2: the reference (the run with N = 20, K = active-set) is not reached: no run is there; expected "
        "at least one run of the study that can be solved; take the exclusion back, or hold other axes under 'at'");
}

TEST_CASE("references that cannot be one") {
  SmallStudy study(R"(quantities = { tip = "energy.point-load" }
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
[reference]
richardson = "N"
stored = { tipp_N_mm = 3 }
)");
  CHECK(study.errors() ==
        "study.toml:7:1: [reference] has both 'stored' and 'richardson'; expected one of: closed-form, stored, finest, "
        "richardson; leave one of them");
  CHECK(SmallStudy(R"([axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
[reference]
richardson = "N"
)")
            .errors() ==
        "study.toml:6:14: 'richardson' of [reference] is axis 'N' with 2 values; expected at least three meshes; add "
        "values, or compare with finest = \"N\"");
  CHECK(SmallStudy(R"(quantities = { tip = "energy.point-load" }
[axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
[reference]
closed-form = { tip_N_mm = "3 * M" }
)")
            .errors()
            .rfind("study.toml:7:28: the closed form of 'tip_N_mm' cannot be evaluated (", 0) == 0);
}

TEST_CASE("a file that is missing, no TOML, a composition, or without an axis") {
  std::vector<InputError> errors;
  study::read_study("nowhere.toml", false, errors);
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].text() ==
        "nowhere.toml: cannot read the file (No such file or directory); expected a study in TOML; check the path");
  CHECK(SmallStudy("axes = 3 = 4\n").errors().rfind("study.toml:3:", 0) == 0);
  CHECK(SmallStudy("", "schema = 1\n[[wire]]\nname = \"w\"\n").errors() ==
        "study.toml:1:1: this is a composition, not a study; expected a file with base and [axes]; solve it with "
        "`bowstring solve`, or name it as the base of a study");
  CHECK(SmallStudy("").errors().rfind("study.toml:1:1: the study has no axis; expected a table [axes]", 0) == 0);
}

TEST_CASE("a base that cannot be read is told once, not for every run") {
  SmallStudy study("[axes]\nN = { path = \"wire.rod.geometry.nodes\", values = [10, 20] }\n",
                   "schema = 1\nbase = \"rood.toml\"\n");
  CHECK(study.errors() ==
        "rood.toml: cannot read the file (No such file or directory); expected a composition in TOML; check the path");
}

TEST_CASE("a value of a range that no run can take, wherever it is in the range; of a sample it makes refused runs") {
  const auto study = [](const std::string& form) {
    return SmallStudy("[axes]\nA = { " + form + R"( }
N = { path = "wire.rod.geometry.nodes", values = [10, 20] }
)");
  };
  const std::string path = R"(path = "energy.wire-bending.bending-stiffness", )";
  for (const char* range : {R"(["-2 N mm^2", "1 N mm^2"])", R"(["1 N mm^2", "-2 N mm^2"])"}) {
    CHECK(study(path + "linear = " + range + ", count = 3").errors().find("is -2 N mm^2, out of bounds") !=
          std::string::npos);
  }
  const std::string stiffness = "{ " + path + R"(linear = ["-1 N mm^2", "9 N mm^2"] })";
  const study::Plan plan = study("sobol = { EI = " + stiffness + " }, count = 32").plan();
  int refused = 0;
  for (const study::PlannedRun& run : plan.runs) refused += run.refusal.empty() ? 0 : 1;
  CHECK(refused > 0);
  CHECK(refused < 32);
}

TEST_CASE("more combinations than can be walked are told before they are made") {
  SmallStudy study(R"(exclude = [{ A = "1 N mm^2" }]
[axes]
A = { path = "energy.wire-bending.bending-stiffness", linear = ["1 N mm^2", "2 N mm^2"], count = 2000 }
N = { path = "wire.rod.geometry.nodes", linear = [3, 5000], count = 2000 }
)");
  CHECK(
      study.errors() ==
      "study.toml: the axes make 4e+06 combinations; expected between 1 and 1000000 runs; shorten the axes, or take a "
      "sample");
}

TEST_CASE("one number twice, two axes of compositions, a column that is taken") {
  SmallStudy study(R"(quantities = ["quantities.contact_count", { path = "contacts.force_N", reduce = "count" }]
[axes]
A = { path = "energy.wire-bending.bending-stiffness", values = ["1 N mm^2", "0.000001 N m^2"] }
scene = { base = ["rod.toml"] }
other = { base = ["rod.toml"] }
contact_count = { path = "solver.type", values = ["interior-point", "active-set"] }
)");
  CHECK(
      study.errors() ==
      "study.toml:5:64: axis 'A' has a value twice; expected values that differ; leave one of them\n"
      "study.toml:8:1: axis 'contact_count' has the column 'contact_count', which is taken; expected a name of its "
      "own; rename the axis\n"
      "study.toml:7:1: axes 'scene' and 'other' both name the composition of a run; expected one composition for each "
      "run; make one axis of them, or leave their combinations out");
  SmallStudy apart(R"(combine = "one-at-a-time"
[axes]
scene = { alternatives = { same = {}, other = { base = "rod.toml" } } }
again = { alternatives = { same = {}, other = { base = "rod.toml" } } }
)");
  CHECK(apart.errors() == "");
}

TEST_CASE("a reference whose finest mesh is excluded, or that holds an axis which is walked with its own") {
  const std::string axes = R"([axes]
N = { path = "wire.rod.geometry.nodes", values = [10, 20, 40] }
A = { path = "energy.wire-bending.bending-stiffness", values = ["1 N mm^2", "2 N mm^2", "3 N mm^2"] }
[reference]
)";
  CHECK(
      SmallStudy("exclude = [{ N = 40, A = \"1 N mm^2\" }]\n" + axes + "finest = \"N\"\nat = { A = \"1 N mm^2\" }\n")
          .errors() ==
      "study.toml:7:2: the reference (the run with N = 40, A = 1 N mm^2) is not reached: no run is there; expected at "
      "least one run of the study that can be solved; take the exclusion back, or hold other axes under 'at'");
  CHECK(SmallStudy("exclude = [{ N = 40 }]\n" + axes + "richardson = \"N\"\n").errors().find("is not reached") !=
        std::string::npos);
  CHECK(
      SmallStudy("zipped = [[\"N\", \"A\"]]\n" + axes + "finest = \"N\"\nat = { A = \"1 N mm^2\" }\n").errors() ==
      "study.toml:9:8: 'at' of [reference] holds 'A', along which the reference is looked for; expected axes that are "
      "not walked with it; remove it");
}

TEST_CASE("a reduced form that the file does not have") {
  SmallStudy study("[axes]\nN = { path = \"wire.rod.geometry.nodes\", values = [10, 20] }\n");
  std::vector<InputError> errors;
  study::read_study(study.file(), true, errors);
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].found == "the study has no [reduced], which --reduced asks for");
}

}  // namespace bowstring
