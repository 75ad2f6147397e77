#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/certificate/verdict.hpp"
#include "core/result/document.hpp"
#include "core/session/refusal.hpp"

namespace bowstring {

/// What a SimulationResult shares with its copies. What is not asked for is not made: the document costs more than a
/// warm start's iterations.
class SimulationData {
 public:
  Refusal refusal;  ///< any: nothing else is there
  Verdict status = Verdict::failed;
  std::string reason;
  std::vector<std::string> warnings;
  std::vector<std::string> input_files;  ///< absolute
  std::vector<StateResult> states;       ///< the last one is the result

  const StateResult& state() const noexcept { return states.back(); }
  bool solved() const noexcept { return !refusal.any(); }
  const std::string& text() const;                 ///< of the document
  const nlohmann::ordered_json& document() const;  ///< null where refused
  const nlohmann::ordered_json& scalars() const;   ///< the document's small tables

 private:
  mutable std::once_flag text_once_, document_once_, scalars_once_;
  mutable std::string text_;
  mutable nlohmann::ordered_json document_, scalars_;
};

}  // namespace bowstring
