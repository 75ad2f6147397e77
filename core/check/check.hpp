#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring {

/// `note`: nothing is wrong, and the user should know. `failed`: what was claimed does not hold.
enum class CheckVerdict : int { ok, note, failed };
/// "ok", "note", "FAILED".
const char* check_verdict_name(CheckVerdict verdict) noexcept;

/// One thing that was judged.
struct CheckLine {
  CheckVerdict verdict = CheckVerdict::ok;
  std::string subject;                                      ///< "energy 'anchoring' on 'iliac'"
  std::string what;                                         ///< "gradient", "Hessian", "rotation", …
  double error = std::numeric_limits<double>::quiet_NaN();  ///< relative; not a number where nothing was measured
  std::string where;                                        ///< place of that error, "" where there is none
  std::string text;                                         ///< one sentence for people, may be ""
};

/// Orders of magnitude of one field of one curve. Numbers are per tangent number: a position's gradient is in N, an
/// angle's in N mm.
struct FieldScale {
  std::string curve, field;
  bool angle = false;
  int unknowns = 0;                                        ///< free ones
  double gradient = 0.0;                                   ///< of the energies, largest entry over all states
  double smallest_diagonal = 0.0, largest_diagonal = 0.0;  ///< |entries| of the energies' Hessian at the start
};

/// Orders of magnitude of one group of rows. A gradient is per mm: derivatives in angles are divided by the mean
/// adjacent edge length.
struct RowScale {
  std::string name;
  int rows = 0;
  int vanishing = 0;                                       ///< rows without a gradient at the start
  double smallest_gradient = 0.0, largest_gradient = 0.0;  ///< over all states
  int active = 0;                                          ///< at a bound at the start; of equalities: those that hold
  double violation = 0.0;                                  ///< largest, at the start
};

/// What was found of a composition's own terms. Nothing is solved.
struct CheckReport {
  int states = 0, directions = 0;  ///< that derivatives were compared at and along
  std::vector<CheckLine> derivatives, invariances, scaling, modes;
  std::vector<FieldScale> fields;
  std::vector<RowScale> row_groups;

  /// The worst of all lines.
  CheckVerdict verdict() const noexcept;
};

struct CheckOptions {
  unsigned seed = 1;  ///< of perturbed states and directions
  int perturbed_states = 2;
  double first_tolerance = 1e-6;   ///< relative, of gradients and Jacobians
  double second_tolerance = 1e-5;  ///< relative, of Hessians
};

/// Judges derivatives, invariances, scaling and rigid modes of the assembled scene, term by term. Evaluations that fail
/// are lines of the report. Leaves the assembly accepted at its start.
CheckReport check(Assembly& assembly, const CheckOptions& options = {});

}  // namespace bowstring
