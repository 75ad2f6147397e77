#include <doctest/doctest.h>

#include "tests/composition/workbench.hpp"

using namespace bowstring;
using test::texts;
using test::Workbench;
using Texts = std::vector<std::string>;

namespace {

/// Offers no solver.
class WithoutSolvers : public test::FakeRegistry {
 public:
  const ComponentDescriptor* find(Kind kind, const std::string& name, Status& status) override {
    if (kind != Kind::solver) return test::FakeRegistry::find(kind, name, status);
    status = Status::failure(Code::invalid_input, "");
    return nullptr;
  }
  std::vector<std::string> names(Kind kind) const override {
    return kind == Kind::solver ? std::vector<std::string>{} : test::FakeRegistry::names(kind);
  }
};

}  // namespace

TEST_CASE("a plugin that cannot be used is no error of the input, and does not hide one") {
  Workbench bench;
  bench.registry.break_plugin(Kind::energy, "anchoring", "libanchoring.so: another ABI");
  bench.registry.break_plugin(Kind::solver, "ipopt", "not built");
  const CompositionOutcome alone = bench.load_text(test::small_scene);
  CHECK_FALSE(alone.composition.has_value());
  CHECK(alone.errors.empty());
  CHECK(alone.plugin_failure.code == Code::failed);
  CHECK(alone.plugin_failure.text == "scene.toml:20:1: libanchoring.so: another ABI");

  const CompositionOutcome both = bench.load("scene.toml", {{"wire.w.radius", "0"}});
  CHECK(both.plugin_failure.code == Code::failed);
  CHECK(texts(both.errors) == Texts{"--set wire.w.radius=0: 'radius' of wire 'w' is 0, out of bounds; "
                                    "expected more than 0 mm; write a larger number"});
}

TEST_CASE("a plugin whose declared default breaks its own schema is at fault itself") {
  Workbench bench;
  ParameterDeclaration bad{"depth", ParameterType::scalar, "mm", "\"1 N\"", ""};
  bench.registry.add(Kind::enforcement, "kkt", {bad});
  const CompositionOutcome outcome = bench.load_text(test::small_scene);
  CHECK(outcome.errors.empty());
  CHECK(outcome.plugin_failure.code == Code::failed);
  CHECK(outcome.plugin_failure.text ==
        "the plugin of enforcement 'kkt' of [enforcement] declares a default that its own schema refuses: wrong unit: "
        "'depth' of enforcement 'kkt' of [enforcement] is text \"1 N\"; expected a quantity in mm; write \"1 mm\"");
}

TEST_CASE("a default that nobody offers is named as one") {
  Workbench bench;
  CHECK(bench.errors(test::small_scene, {{"wire.w.kinematics", "node-frames"}}) ==
        Texts{"--set wire.w.kinematics=node-frames: unknown kinematics 'node-frames'; expected one of: edge-frames, "
              "nodes; did you mean 'edge-frames'?"});
  WithoutSolvers registry;
  bench.write("scene.toml", test::small_scene);
  CHECK(texts(load_composition({"scene.toml", {}}, registry).errors) ==
        Texts{"scene.toml:1:1: unknown solver 'interior-point', the default of [solver]; expected an installed solver, "
              "but none "
              "is; `bowstring plugins solver` says what is installed"});
}
