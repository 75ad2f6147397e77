#pragma once

#include <functional>
#include <memory>

#include "core/procedure/parameter_family.hpp"
#include "core/procedure/records.hpp"

namespace bowstring {

/// A composition at one of its states, solved.
struct SolvedState {
  std::unique_ptr<Session> session;
  Solution solution;
};

/// Walks [continuation] of the session's composition from one end to the other. The first point is solved with the
/// composition's solver, and so is the last one, from the point that the walk came to. In between the path of
/// equilibria is followed (PathFollower); where that is not possible (the mesh changes, rows are not exact, "never"),
/// and where it fails without a fold in sight, the solver takes the step.
///
/// Where the other end is not reached, the state is the last one of the path, its verdict `stalled`, with the reason.
SolvedState walk(const CompositionRequest& request, std::unique_ptr<Session> session,
                 const ParameterFamily::Build& build, const std::function<bool(const IterationRecord&)>& progress,
                 Path& path);

}  // namespace bowstring
