#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/result/recorded_result.hpp"

namespace bowstring {

/// The document of the run that a run of a study started from.
struct Predecessor {
  std::string file;
  std::string text;     ///< JSON
  std::string problem;  ///< why it cannot be read: "No such file or directory"; ""
};

/// What it takes to solve again what a result document asks, and what stands against the same bits.
struct Rerun {
  CompositionRequest request;
  std::optional<CarriedState> carried;  ///< the predecessor's state, which its first state starts from
  /// What is not what it was, each in a sentence. Empty: the same bits are promised.
  std::vector<std::string> differences;
  /// A plugin that is needed and known, but cannot be loaded or used: no solve is possible at all.
  Status unusable;
};

/// The request alone: `file` is what messages call the composition; its own paths are absolute.
CompositionRequest request_of(const RecordedResult& result, const std::string& file);

/// Compares the programs, and the state that the solve started from, with what is here. Opens the recorded plugins, and
/// solves nothing. `predecessor`: where the result names one.
Rerun plan_rerun(const RecordedResult& result, const std::string& file, const std::optional<Predecessor>& predecessor,
                 Registry& registry);

}  // namespace bowstring
