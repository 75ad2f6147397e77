#pragma once

#include <string>
#include <vector>

#include "core/result/quantities.hpp"

namespace bowstring {

/// What a result document says of an equilibrium beside the one that it is about.
struct StateSummary {
  Certificate certificate;
  std::vector<std::string> energy_label;
  Readings readings;
};

/// One point of a path of equilibria.
struct PathPoint {
  double share = 0.0;             ///< of the way from the one value to the other; beyond 0…1 where the path folds
  std::vector<double> parameter;  ///< the value, in the path's unit
  double arclength = 0.0;         ///< from the first point: |Δq|/L and the share together, without dimension
  int iterations = 0;
  bool by_solver = false;  ///< found by the composition's solver, not along the path
  StateSummary state;
};

/// Where a path changes its course or its stability.
struct CriticalPoint {
  enum class Kind : int { fold, bifurcation };
  Kind kind = Kind::fold;
  double share = 0.0;
  double uncertainty = 0.0;  ///< of `share`
  std::vector<double> parameter;
  double energy = 0.0;                    ///< N mm
  int index_before = 0, index_after = 0;  ///< negative directions
};
const char* critical_name(CriticalPoint::Kind kind) noexcept;  ///< "fold", "bifurcation"

/// A walk from one value of the composition to another.
struct Path {
  std::string value;  ///< what was walked: "energy.axial-tension.tension"
  std::string unit;   ///< "" of bare numbers
  bool list = false;  ///< the value is a list of numbers
  bool reached = false;
  std::string reason;  ///< why not
  /// What was asked for, resolved, where the walk has left its composition with another value; "": it has not.
  std::string asked_composition;
  std::vector<PathPoint> points;
  std::vector<CriticalPoint> critical;
};

/// One of several equilibria of a scene.
struct Equilibrium {
  std::string origin;  ///< "start 3", "between equilibria 1 and 2"
  int basin = 0;       ///< starts that led to it
  std::vector<double> q, multipliers;
  StateSummary state;
};

}  // namespace bowstring
