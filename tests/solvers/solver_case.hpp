#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/composition/defaults.hpp"
#include "core/interfaces/solver.hpp"
#include "tests/assembly/small_scene.hpp"
#include "tests/certificate/solved_scene.hpp"
#include "tests/solvers/row_problem.hpp"

namespace bowstring::testing {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

using OwnedSolver = std::unique_ptr<Solver, Destructor>;

/// One parameter of a solver that a test sets, of whatever its type is.
using SetParameter = std::function<ParameterValue&(const char* key, ParameterType type)>;

/// A solver plugin by name, with its defaults and what `set` makes of them.
inline OwnedSolver solver_plugin(const char* name, const std::function<void(const SetParameter&)>& set) {
  Status status;
  const ComponentDescriptor* component = plugin_host().find(Kind::solver, name, status);
  REQUIRE_MESSAGE(component != nullptr, status.text);
  ParameterSet parameters = default_parameters(*component);
  set([&](const char* key, ParameterType type) -> ParameterValue& {
    for (ParameterValue& found : parameters.values) {
      if (found.key == key) return found;
    }
    parameters.values.emplace_back();
    parameters.values.back().key = key;
    parameters.values.back().type = type;
    return parameters.values.back();
  });
  void* raw = nullptr;
  status = component->create(parameters, &raw);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return OwnedSolver(static_cast<Solver*>(raw), component->destroy);
}

struct Answer {
  Status status;
  SolverResult result;
};

inline Answer solve_with(Solver& solver, Problem& problem, const std::vector<double>& start,
                         const std::function<bool(const IterationRecord&)>& progress = {}) {
  Answer answer;
  SolverContext context;
  context.on_iteration = progress;
  answer.status = solver.solve(problem, start, context, answer.result);
  return answer;
}

/// ½ (x − 3)² + ½ (y − 1)² + (z + 2)².
inline const std::vector<double> stiffness = {1.0, 1.0, 2.0};
inline const std::vector<double> rest = {3.0, 1.0, -2.0};

/// A step of at most 0.4 from the last accepted point.
inline Status within_reach(const RowProblem& problem, const std::vector<double>& q) {
  double squared = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) squared += (q[i] - problem.reference[i]) * (q[i] - problem.reference[i]);
  return squared <= 0.16 ? Status{} : Status{Code::refused, {}};
}

inline void check_point(const std::vector<double>& q, const std::vector<double>& expected, double tolerance) {
  REQUIRE(q.size() == expected.size());
  REQUIRE(largest(expected) > 0.5);
  CHECK(largest_difference(q, expected) <= tolerance);
}

}  // namespace bowstring::testing
