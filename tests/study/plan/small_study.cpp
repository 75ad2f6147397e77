#include "tests/study/plan/small_study.hpp"

#include <stdexcept>
#include <utility>

namespace bowstring::testing {
namespace {

constexpr const char* rod = R"(schema = 1
[scene]
dimension = 2
[[wire]]
name = "rod"
geometry = { type = "line", length = "100 mm", nodes = 11 }
radius = "0.4 mm"
ends = ["clamped", "free"]
[[energy]]
type = "wire-bending"
on = "rod"
bending-stiffness = "1000 N mm^2"
[[energy]]
type = "point-load"
on = "rod"
force = ["0 N", "0.01 N"]
at = "last"
)";

}  // namespace

SmallStudy::SmallStudy(const std::string& text, const std::string& opening) {
  folder_.write("rod.toml", rod);
  folder_.write("study.toml", opening + text);
}

study::Plan SmallStudy::plan(bool reduced) {
  Refusal refusal;
  study::StudyFile study = study::read_study(file(), reduced, refusal.errors);
  if (refusal.any()) throw std::runtime_error(refusal.text());
  std::optional<study::Plan> plan = study::make_plan(std::move(study), host_, refusal);
  if (!plan) throw std::runtime_error(refusal.text());
  return std::move(*plan);
}

std::string SmallStudy::errors() {
  Refusal refusal;
  study::StudyFile study = study::read_study(file(), false, refusal.errors);
  if (refusal.any()) {
    study::check_values(std::move(study), host_, refusal);
  } else {
    study::make_plan(std::move(study), host_, refusal);
  }
  return replaced(refusal.text(), folder_.path() + "/", "");
}

std::vector<std::string> SmallStudy::runs() {
  const study::Plan all = plan();
  std::vector<std::string> out;
  for (const study::PlannedRun& run : all.runs) {
    std::string text;
    for (std::size_t a = 0; a < run.choice.size(); ++a) {
      text += (a > 0 ? "/" : "") + all.study.axes[a].data.label[static_cast<std::size_t>(run.choice[a])];
    }
    out.push_back(text);
  }
  return out;
}

}  // namespace bowstring::testing
