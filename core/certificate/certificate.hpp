#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"
#include "core/certificate/second_order.hpp"
#include "core/certificate/verdict.hpp"
#include "core/composition/composition.hpp"
#include "core/contact/crossing.hpp"

namespace bowstring {

/// The wire of one contact pair against the spline wall of its vessel.
struct PairPenetration {
  int wire = 0, vessel = 0;
  contact::Penetration dense;  ///< 16 parts of every chord
  contact::CrossingCheck crossing;
};

/// What the kernel finds at a point, from the problem and never from the solver's word.
struct Certificate {
  double stationarity = 0.0;     ///< N: largest entry of the projected Lagrangian gradient, rotations per edge length
  double rounding_floor = 0.0;   ///< N: what the formulations' rounding leaves of it
  double penetration = 0.0;      ///< mm: largest violation of a row
  int worst_row = -1;            ///< the row of that
  double complementarity = 0.0;  ///< N mm: largest |multiplier × distance of the row to its bound|
  double minimum_multiplier = 0.0;                      ///< N: smallest signed multiplier, 0 without signed rows
  double minimum_stretch = 1.0, maximum_stretch = 1.0;  ///< ℓ/ℓ⁰ over vessel edges
  std::vector<PairPenetration> pairs;
  std::vector<int> weakly_active;       ///< inequality rows at their bound whose multiplier nearly vanishes
  std::vector<std::string> folds;       ///< each: place and amount of a folded edge or an active bound
  std::vector<std::string> wire_folds;  ///< each: place of a wire's edge that turns back against the one before it
  std::vector<std::string> crossings;   ///< each: place and amount of a wall crossed between rows
  bool first_order = false;  ///< stationarity, rows, complementarity and multipliers are within the thresholds
  SecondOrder second_order;  ///< judged where `first_order` holds
  Verdict verdict = Verdict::failed;
  std::string reason;

  std::optional<double> dense_penetration() const;
};

/// Judges a point. `claim` and `claim_reason` only name the cause where the thresholds are not met.
Status certify(Assembly& assembly, Span<const double> q, Span<const double> multipliers,
               const CertificateTable& thresholds, Claim claim, const std::string& claim_reason, Certificate& out);

}  // namespace bowstring
