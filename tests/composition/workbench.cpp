#include "tests/composition/workbench.hpp"

#include <unistd.h>

#include <fstream>

namespace bowstring::test {

namespace fs = std::filesystem;

Workbench::Workbench() : previous_(fs::current_path()) {
  std::string pattern = (fs::temp_directory_path() / "bowstring-composition-XXXXXX").string();
  REQUIRE(mkdtemp(pattern.data()) != nullptr);
  folder_ = fs::canonical(pattern);
  fs::current_path(folder_);
}

Workbench::~Workbench() {
  std::error_code ignored;
  fs::current_path(previous_, ignored);
  fs::remove_all(folder_, ignored);
}

void Workbench::write(const std::string& file, const std::string& text) const {
  const fs::path path = folder_ / file;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

CompositionOutcome Workbench::load(const std::string& file, const std::vector<Override>& overrides) {
  return load_composition({file, overrides}, registry);
}

CompositionOutcome Workbench::load_text(const std::string& text, const std::vector<Override>& overrides) {
  write("scene.toml", text);
  return load("scene.toml", overrides);
}

Composition Workbench::loaded(const std::string& text, const std::vector<Override>& overrides) {
  CompositionOutcome outcome = load_text(text, overrides);
  for (const InputError& error : outcome.errors) FAIL_CHECK(error.text());
  CHECK(outcome.plugin_failure.ok());
  REQUIRE(outcome.composition.has_value());
  return *outcome.composition;
}

std::vector<std::string> Workbench::errors(const std::string& text, const std::vector<Override>& overrides) {
  const CompositionOutcome outcome = load_text(text, overrides);
  CHECK_FALSE(outcome.composition.has_value());
  return texts(outcome.errors);
}

std::vector<std::string> texts(const std::vector<InputError>& errors) {
  std::vector<std::string> result;
  for (const InputError& error : errors) result.push_back(error.text());
  return result;
}

const char* const planar_iliac = R"(schema = 1
title  = "Planar iliac with a Lunderquist wire"

[scene]
dimension = 2                                   # 2 or 3

[[vessel]]
name     = "iliac"
geometry = { type = "sinusoid", chord = "150 mm", amplitude = "25 mm", periods = 1, nodes = 80, sampling = "uniform-x" }
radius   = "6 mm"
ends     = ["pinned", "pinned"]

[[wire]]
name   = "lunderquist"
vessel = "iliac"
kinematics = "edge-frames"
nodes  = 80
radius = "0.4445 mm"
ends   = ["pinned", "pinned"]

[[energy]]
type = "wire-bending"
on   = "lunderquist"
bending-stiffness = "65 N mm^2"
[[energy]]
type = "vessel-strain"
on   = "iliac"
bending-stiffness   = "200 N mm^2"
torsional-stiffness = "133 N mm^2"
stretch-stiffness   = "11.1 N"
[[energy]]
type = "anchoring"
on   = "iliac"
stiffness = "0.03 N/mm"
[[energy]]
type = "axial-tension"
on   = "lunderquist"
tension = "10 N"

[[constraint]]
name = "lumen"
type = "node-wise-contact"
on   = ["lunderquist", "iliac"]
centerline = "spline"

[enforcement]
type = "kkt"
[solver]
type = "interior-point"
tolerance = 1e-8
[certificate]
stationarity = "1e-5 N"
)";

const char* const small_scene = R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "v"
geometry = { type = "sinusoid", chord = "150 mm", amplitude = "25 mm" }
radius = "6 mm"
[[wire]]
name = "w"
vessel = "v"
radius = "0.4 mm"
[[energy]]
type = "wire-bending"
on = "w"
bending-stiffness = "65 N mm^2"
[[energy]]
type = "axial-tension"
on = "w"
tension = "10 N"
[[energy]]
type = "anchoring"
on = "v"
stiffness = "0.01 N/mm^2"
[[constraint]]
name = "lumen"
type = "node-wise-contact"
on = ["w", "v"]
)";

}  // namespace bowstring::test
