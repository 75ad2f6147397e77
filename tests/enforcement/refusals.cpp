#include <doctest/doctest.h>

#include <string>

#include "tests/enforcement/enforcement_case.hpp"

namespace bowstring::testing {

namespace {

/// A scene in which `enforcement` stands for the table of that name; what is said of it, after its place.
std::string refusal(const std::string& enforcement, SmallScene scene = {}) {
  return refusal_of(edited(scene.text(), "[solver]", "[enforcement]\n" + enforcement + "\n[solver]"));
}

}  // namespace

TEST_CASE("names that are no constraint's are refused with those there are and the nearest, at their table's place") {
  for (const std::string type : {"penalty", "augmented-lagrangian"}) {
    const std::string table = "type = \"" + type + "\"\n";
    std::string text = refusal(table + "on = \"lumne\"");
    CHECK_MESSAGE(contains(text, ":40:1: enforcement '" + type +
                                     "': 'on' names 'lumne', which is no constraint; expected 'lumen', the scene's "
                                     "constraints; did you mean 'lumen'?"),
                  text);
    text = refusal(table + "on = [\"lumen\", \"gap\"]");
    CHECK_MESSAGE(contains(text,
                           "'on' names 'gap', which is no constraint; expected 'lumen', the scene's constraints; "
                           "name one of them"),
                  text);
    text = refusal(table + "on = \"vessel.closure\"");
    CHECK_MESSAGE(contains(text,
                           "'on' names the rows 'vessel.closure', edge closure of 'vessel' (14), which hold a curve "
                           "together and stay exact; expected 'lumen', the scene's constraints; remove it"),
                  text);
    SmallScene without;
    without.contact = "";
    text = refusal(table + "on = \"lumen\"", without);
    CHECK_MESSAGE(contains(text,
                           "'on' names 'lumen', which is no constraint; expected nothing, as the scene has no "
                           "constraint; remove 'on'"),
                  text);
  }
}

TEST_CASE("weights and forces have to be positive, words those there are, with their place") {
  const auto check = [](const std::string& text, const std::string& expected) {
    CHECK_MESSAGE(contains(text, expected), text);
  };
  const std::string penalty = "type = \"penalty\"\n", augmented = "type = \"augmented-lagrangian\"\n";
  check(refusal(penalty + "weight = \"0 N/mm\""), ":42:10: 'weight' of enforcement 'penalty' is ");
  check(refusal(penalty + "weight = \"-5 N/mm\""), "expected more than 0 N/mm");
  check(refusal(penalty + "weight = \"5 N\""), "'weight' of enforcement 'penalty'");
  check(refusal(penalty + "smoothing-force = 0.0"), ":42:19: 'smoothing-force' of enforcement 'penalty' is ");
  check(refusal(penalty + "first-weight = 0.0"), "'first-weight' of enforcement 'penalty' is ");
  check(refusal(penalty + "form = \"cubic\""), "'quadratic' or 'log-quadratic'");
  check(refusal(penalty + "bias = \"guessed\""), "'estimated' or 'measured'");
  check(refusal(penalty + "wieght = 5.0"), "did you mean 'weight'?");
  check(refusal(penalty + "on = 5"), "a name, or a list of names");
  check(refusal(augmented + "first-weight = \"0 N/mm\""), "'first-weight' of enforcement 'augmented-lagrangian' is ");
  check(refusal(augmented + "growth = 0.5"), ":42:10: 'growth' of enforcement 'augmented-lagrangian' is ");
  check(refusal(augmented + "tolerance = 0.0"), "'tolerance' of enforcement 'augmented-lagrangian' is ");
  check(refusal(augmented + "max-outer-iterations = 0"), "'max-outer-iterations' of enforcement");
}

TEST_CASE("a solver is asked about what is left") {
  const auto text = [](const std::string& on) {
    return edited(edited(SmallScene{}.text(), "type = \"ipopt\"", "type = \"trust-region\""), "[solver]",
                  "[[constraint]]\nname = \"other\"\ntype = \"node-wise-contact\"\non = [\"wire\", \"vessel\"]\n"
                  "[enforcement]\ntype = \"penalty\"\n" +
                      on + "[solver]");
  };
  CHECK(session_of_text(text("")) != nullptr);
  CHECK(session_of_text(text("on = [\"other\", \"lumen\"]\n")) != nullptr);
  const std::string refused = refusal_of(text("on = \"lumen\"\n"));
  CHECK_MESSAGE(contains(refused, "solver 'trust-region' refuses this problem: it takes no inequality rows"), refused);
  CHECK_MESSAGE(contains(refused, "constraint 'other' (5)"), refused);
  CHECK_MESSAGE(!contains(refused, "constraint 'lumen'"), refused);
}

}  // namespace bowstring::testing
