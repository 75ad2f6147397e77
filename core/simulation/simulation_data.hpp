#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/certificate/verdict.hpp"
#include "core/session/refusal.hpp"

namespace bowstring {

/// What a SimulationResult shares with its copies.
struct SimulationData {
  Refusal refusal;  ///< any: nothing else is there
  Verdict status = Verdict::failed;
  std::string reason;
  std::vector<std::string> warnings;
  std::vector<std::string> input_files;  ///< absolute
  std::string text;                      ///< of the document
  nlohmann::ordered_json document;
};

}  // namespace bowstring
