#include "core/compare/rerun.hpp"

#include <memory>
#include <utility>

#include "core/composition/read_file.hpp"
#include "core/composition/resolved_toml.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring {
namespace {

std::string shortened(const std::string& sha256) { return sha256.substr(0, 12) + "…"; }

/// In what the document that the solve started from differs from what it was; "" in nothing.
std::string start_difference(const StartOrigin& start) {
  if (start.file.empty()) return "start: it was a state in memory then, which is in no document";
  std::string text;
  if (const std::string why = read_file(start.file, text); !why.empty()) {
    return "start '" + start.file + "': sha256 " + shortened(start.sha256) + " then, cannot be read here (" + why + ")";
  }
  const std::string sha256 = sha256_hex(text);
  if (sha256 == start.sha256) return "";
  return "start '" + start.file + "': sha256 " + shortened(start.sha256) + " then, " + shortened(sha256) + " here";
}

/// Takes the predecessor's state; answers why it is not the one that the solve started from, "" if it is.
std::string take_predecessor(const RecordedResult& result, const Predecessor& predecessor, Rerun& out) {
  const std::string name = "start: the run " + result.predecessor + " that it started from";
  if (!predecessor.problem.empty()) {
    return name + " has no document '" + predecessor.file + "' here (" + predecessor.problem + ")";
  }
  std::vector<DocumentFlaw> flaws;
  const std::string document = "the start '" + predecessor.file + "'";
  RecordedState state = read_recorded_state(predecessor.text, document, flaws);
  if (!flaws.empty()) return name + " is of no use here: " + flaws.front().found;
  const std::string here = state.sha256;
  out.carried = CarriedState{std::make_shared<const RecordedState>(std::move(state)), document, predecessor.file,
                             predecessor.file, std::nullopt};
  const std::string then = result.start ? result.start->sha256 : "";
  if (then.empty() || then == here) return "";
  return name + ": sha256 " + shortened(then) + " then, " + shortened(here) + " here (" + predecessor.file + ")";
}

}  // namespace

CompositionRequest request_of(const RecordedResult& result, const std::string& file) {
  CompositionRequest out;
  out.file = file;
  out.text = resolved_toml(result.composition);
  return out;
}

Rerun plan_rerun(const RecordedResult& result, const std::string& file, const std::optional<Predecessor>& predecessor,
                 Registry& registry) {
  Rerun out;
  out.request = request_of(result, file);
  out.differences = provenance_differences(result.provenance, provenance_here(result.provenance, registry));
  for (const PluginProvenance& plugin : result.provenance.plugins) {
    Status status;
    if (registry.find(plugin.kind, plugin.name, status) != nullptr || status.code == Code::invalid_input) continue;
    if (out.unusable.ok()) out.unusable = status;
  }
  const std::string start = predecessor    ? take_predecessor(result, *predecessor, out)
                            : result.start ? start_difference(*result.start)
                                           : "";
  if (!start.empty()) out.differences.push_back(start);
  return out;
}

}  // namespace bowstring
