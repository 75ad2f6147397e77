#pragma once

#include <limits>
#include <string>

#include "core/interfaces/parameter.hpp"
#include "core/interfaces/solver.hpp"
#include "plugins/sdk/guard.hpp"

/// What solvers have in common that hand the problem, on a chart and with a structure that stays, to a library.
namespace bowstring::backend {

inline constexpr ParameterDeclaration tolerance_key{
    .key = "tolerance",
    .type = ParameterType::scalar,
    .unit = "",
    .default_text = "1e-8",
    .description = "absolute target: stationarity in N, rows in mm, complementarity in N mm",
    .lower = 0.0,
    .lower_exclusive = true};

/// What an iteration is differs from solver to solver, and so does how many are plenty.
constexpr ParameterDeclaration max_iterations_key(const char* default_text, const char* description) {
  return {.key = "max-iterations",
          .type = ParameterType::integer,
          .unit = "",
          .default_text = default_text,
          .description = description,
          .lower = 1.0};
}

inline constexpr ParameterDeclaration time_limit_key{
    .key = "time-limit",
    .type = ParameterType::scalar,
    .unit = "s",
    .default_text = "",
    .description = "wall-clock seconds after which the best point is returned",
    .lower = 0.0,
    .lower_exclusive = true};

inline constexpr ParameterDeclaration step_guard_key{
    .key = "step-guard",
    .type = ParameterType::scalar,
    .unit = "",
    .default_text = "0.5",
    .description =
        "share of its clearance that a wire node may move, relative to its wall, in one step; 0 switches the "
        "guard off, and soft wires may then tunnel through the wall",
    .lower = 0.0};

/// For Problem::set_guard.
inline double step_guard(const ParameterSet& parameters) {
  const double guard = parameters.scalar(step_guard_key.key);
  return guard > 0.0 ? guard : std::numeric_limits<double>::infinity();
}

/// Seconds; infinite where the user gives none.
inline double time_limit(const ParameterSet& parameters) {
  return parameters.has(time_limit_key.key) ? parameters.scalar(time_limit_key.key)
                                            : std::numeric_limits<double>::infinity();
}

/// A pattern that stays has to cover what a wire slides over: two segments, or 10 mm where that is more.
inline SolverTraits traits() noexcept {
  SolverTraits traits;
  traits.window_segments = 2;
  traits.window_length = 10.0;
  return traits;
}

/// Throws `unsupported` where there are more equality rows than unknowns.
inline void check_equalities(const char* library, const ProblemSummary& summary) {
  if (summary.equalities <= summary.unknowns) return;
  throw StatusError(Code::unsupported, std::string(library) + " takes no problem with more equality rows (" +
                                           std::to_string(summary.equalities) + ") than unknowns (" +
                                           std::to_string(summary.unknowns) + ")");
}

/// Sets the step guard of a problem, and takes it off again whatever ends the solve.
class Guarded {
 public:
  Guarded(Problem& problem, double fraction) : problem_(problem) { problem_.set_guard(fraction); }
  ~Guarded() { problem_.set_guard(std::numeric_limits<double>::infinity()); }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

 private:
  Problem& problem_;
};

}  // namespace bowstring::backend
