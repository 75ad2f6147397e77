#pragma once

#include <string>
#include <vector>

#include "core/measure/curve_measure.hpp"
#include "core/model/scene.hpp"
#include "core/result/quantities.hpp"
#include "core/session/refusal.hpp"
#include "core/transport/transport_comparison.hpp"

namespace bowstring {

/// What one [[loss]] of a composition came to.
struct LossRecord {
  std::string name, on, against;
  Status status;           ///< not ok: why there is no value
  CurveMeasure predicted;  ///< the places of the curve, the first measure
  TransportResult result;
};

/// Finds what is known to be wrong with losses before anything is solved: measures that their methods or costs refuse,
/// at the curves' starts. A station beyond its curve is a warning of the scene.
void check_losses(const Composition& composition, Scene& scene, Refusal& refusal);

/// Every loss of a composition at a solution, each cold, so that the bits do not depend on what was solved before.
std::vector<LossRecord> evaluate_losses(const Composition& composition, const Scene& scene, const Readings& readings);

/// A line for each loss without a value: "loss 'shape': …".
std::vector<std::string> loss_warnings(const std::vector<LossRecord>& losses);

}  // namespace bowstring
