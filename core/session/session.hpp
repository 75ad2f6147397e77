#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"
#include "core/certificate/certificate.hpp"
#include "core/composition/composition.hpp"
#include "core/interfaces/enforcement.hpp"
#include "core/session/refusal.hpp"
#include "core/session/start.hpp"

namespace bowstring {

struct Seconds {
  double load = 0.0;   ///< composition read, plugins opened
  double setup = 0.0;  ///< scene built, patterns found
  double solve = 0.0;
  double certificate = 0.0;  ///< the solver's point accepted and certified
  double total = 0.0;
};

/// A composition made ready to be solved.
struct Session {
  Composition composition;
  std::shared_ptr<Scene> scene;  ///< its curves and the labels of its energies stay as they are from solve to solve
  Owned<Solver> solver{nullptr, nullptr};
  Owned<Enforcement> enforcement{nullptr, nullptr};
  std::unique_ptr<Assembly> assembly;
  Start start;        ///< of [start]; its q is empty where the composition starts by itself
  bool bound = true;  ///< rows are bound at `start`, as nothing was solved yet
  Seconds seconds;
};

/// A solved composition: state, multipliers, and what the kernel found there.
struct Solution {
  std::vector<double> q, multipliers;
  SolverResult solver;
  Certificate certificate;
  bool estimated_multipliers = false;  ///< the solver gave none
  std::optional<StartOrigin> start;    ///< empty: the composition's own
  std::vector<std::string> warnings;
};

/// Loads, checks, builds. On refusal the session is null.
///
/// `carried`: a state in memory (core/result/carry.hpp) that the session starts from instead of the document that
/// [start] names; it gives the bits that its document gives. A chain of states is one session after another, each with
/// what was carried out of the one before: prepare(request, registry, refusal, &carried), solve, read_solution, carry.
std::unique_ptr<Session> prepare(const CompositionRequest& request, Registry& registry, Refusal& refusal,
                                 const CarriedState* carried = nullptr);

/// Solves and certifies. `progress` is called after each iteration; false stops with the best point. A failure of a
/// plugin during the solution is a verdict of the solution, not an error.
///
/// `start`: where the solver begins, instead of at the session's own start. A session may be solved any number of
/// times; each solve gives the bits that it would give in a session of its own. Where the solver, of itself, does not
/// reach an equilibrium from a start, it is asked once more, without multipliers and from the scene's own start: a
/// start never makes a status worse.
Solution solve(Session& session, const std::function<bool(const IterationRecord&)>& progress,
               const Start* start = nullptr);

/// Certifies a point that was found elsewhere, in the session as it stands.
Solution certified(Session& session, SolverResult found);

/// New constraints and a new assembly, bound at q (empty: at the scene's own start), as if nothing had been solved
/// before. Where that fails, which throws std::runtime_error, the old ones stay: they fit each other.
void bind_anew(Session& session, const std::vector<double>& q);

}  // namespace bowstring
