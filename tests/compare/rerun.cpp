#include "core/compare/rerun.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "core/compare/number_differences.hpp"
#include "core/composition/sha256.hpp"
#include "core/procedure/procedure.hpp"
#include "core/result/document.hpp"
#include "tests/plugins/plugin_folders.hpp"
#include "tests/compare/reading.hpp"
#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Json = nlohmann::ordered_json;

std::string solved(const Rerun& plan) {
  Refusal refusal;
  const auto procedure = Procedure::prepare(plan.request, plugins(), refusal, plan.carried ? &*plan.carried : nullptr);
  REQUIRE_MESSAGE(procedure != nullptr, refusal.text());
  return result_document(procedure->run({}));
}

/// A run that started from another one, as a study writes both.
struct TwoRuns {
  std::string before, after;
};

TwoRuns two_runs() {
  TwoRuns out;
  const SimulationResult first = small_planar().solve(plugins());
  Simulation stiffer = small_planar();
  stiffer.set("energy.wire-bending.bending-stiffness", "90 N mm^2");
  Json second = Json::parse(stiffer.solve(plugins(), {}, first).json());
  second["study"] = {{"name", "s"}, {"run", 1}, {"hash", "22"}, {"predecessor", "11"}};
  out.before = first.json();
  out.after = second.dump();
  return out;
}

}  // namespace

TEST_CASE("nothing stands against the bits of a document that was just made") {
  const std::string document = small_planar().solve(plugins()).json();
  const Rerun plan = plan_rerun(read_sound(document), "it.json", std::nullopt, plugins());
  CHECK(plan.differences.empty());
  CHECK(plan.unusable.ok());
  const BitComparison bits = compare_bits(document, solved(plan));
  CHECK(bits.same());
  CHECK(bits.numbers > 1000);
}

TEST_CASE("a run of a study starts where its predecessor ended") {
  const TwoRuns runs = two_runs();
  const RecordedResult result = read_sound(runs.after);
  const Rerun plan = plan_rerun(result, "it.json", Predecessor{"11.result.json.gz", runs.before, ""}, plugins());
  CHECK(plan.differences.empty());
  CHECK(compare_bits(runs.after, solved(plan)).same());

  const Rerun cold = plan_rerun(result, "it.json", Predecessor{"11.result.json.gz", "", "No such file"}, plugins());
  REQUIRE(cold.differences.size() == 1);
  CHECK(cold.differences[0] ==
        "start: the run 11 that it started from has no document '11.result.json.gz' here (No such file)");
  CHECK_FALSE(cold.carried);
  CHECK_FALSE(compare_bits(runs.after, solved(cold)).same());

  const Rerun damaged = plan_rerun(result, "it.json", Predecessor{"11.result.json.gz", "{}", ""}, plugins());
  REQUIRE(damaged.differences.size() == 1);
  CHECK(contains(damaged.differences[0], "is of no use here: the start '11.result.json.gz' has no 'format'"));
}

TEST_CASE("a predecessor that is another document than it was is told") {
  const TwoRuns runs = two_runs();
  Json after = Json::parse(runs.after);
  after["provenance"]["start"]["sha256"] = std::string(64, 'a');
  const Rerun plan =
      plan_rerun(read_sound(after.dump()), "it.json", Predecessor{"11.result.json.gz", runs.before, ""}, plugins());
  REQUIRE(plan.differences.size() == 1);
  CHECK(plan.differences[0] == "start: the run 11 that it started from: sha256 aaaaaaaaaaaa… then, " +
                                   sha256_hex(runs.before).substr(0, 12) + "… here (11.result.json.gz)");
}

TEST_CASE("a start in memory, a start document that has changed or gone") {
  const SimulationResult first = small_planar().solve(plugins());
  const std::string from_memory = small_planar().solve(plugins(), {}, first).json();
  const Rerun lost = plan_rerun(read_sound(from_memory), "it.json", std::nullopt, plugins());
  CHECK(lost.differences == std::vector<std::string>{"start: it was a state in memory then, which is in no document"});

  const TemporaryFolder folder;
  const std::string file = folder.write("first.json", first.json());
  Simulation again = small_planar();
  again.set("start.from", file);
  const RecordedResult result = read_sound(again.solve(plugins()).json());
  CHECK(plan_rerun(result, "it.json", std::nullopt, plugins()).differences.empty());
  folder.write("first.json", first.json() + " ");
  const std::string then = "start '" + file + "': sha256 " + sha256_hex(first.json()).substr(0, 12) + "… then, ";
  CHECK(plan_rerun(result, "it.json", std::nullopt, plugins()).differences ==
        std::vector<std::string>{then + sha256_hex(first.json() + " ").substr(0, 12) + "… here"});
  std::filesystem::remove(file);
  CHECK(plan_rerun(result, "it.json", std::nullopt, plugins()).differences ==
        std::vector<std::string>{then + "cannot be read here (No such file or directory)"});
}

}  // namespace bowstring
