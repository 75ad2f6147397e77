// Any text as a composition: it is loaded, or every reason why not is a sentence.

#include <nlohmann/json.hpp>

#include "core/composition/composition.hpp"
#include "core/composition/resolved_toml.hpp"
#include "tests/composition/fake_registry.hpp"
#include "tests/fuzz/scratch.hpp"

namespace {

using namespace bowstring;

constexpr const char* base = R"(schema = 1
[scene]
dimension = 2
[[vessel]]
name = "v"
geometry = { type = "sinusoid", chord = "150 mm", amplitude = "25 mm" }
radius = "6 mm"
)";

void check(const CompositionOutcome& outcome, bool utf8, Registry& registry) {
  for (const InputError& error : outcome.errors) {
    fuzz::require(!error.position.empty() && !error.found.empty(), "an error does not say where or what");
    fuzz::require(!utf8 || fuzz::is_utf8(error.text()), "an error that cuts a letter");
  }
  const bool refused = !outcome.errors.empty() || !outcome.plugin_failure.ok();
  fuzz::require(outcome.composition.has_value() != refused, "neither loaded nor refused, or both");
  if (!outcome.composition) return;
  const nlohmann::json resolved = nlohmann::json::parse(outcome.composition->resolved_json);
  fuzz::require(resolved.is_object(), "the resolved composition is no JSON object");
  CompositionRequest request{"again.toml", {}};
  request.text = resolved_toml(outcome.composition->resolved_json);
  const CompositionOutcome again = load_composition(request, registry);
  fuzz::require(again.composition.has_value(), "a resolved composition that is not read again");
  fuzz::require(again.composition->resolved_json == outcome.composition->resolved_json,
                "a resolved composition that resolves to another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool prepared = [] {
    fuzz::write_scratch("base.toml", base);
    return true;
  }();
  (void)prepared;
  static test::FakeRegistry registry;
  const std::string& file = fuzz::scratch_file(data, size);
  const std::string text(reinterpret_cast<const char*>(data), size);
  check(load_composition({file, {}}, registry), fuzz::is_utf8(text), registry);
  composition_plugin_path({file, {}});
  // The first line as an override of a scene that is right.
  const std::string line = text.substr(0, text.find('\n'));
  const std::size_t equals = line.find('=');
  if (equals != std::string::npos) {
    const Override override{line.substr(0, equals), line.substr(equals + 1)};
    check(load_composition({"base.toml", {override}}, registry), fuzz::is_utf8(line), registry);
  }
  return 0;
}
