#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/interfaces/enforcement.hpp"
#include "tests/solvers/solver_case.hpp"

namespace bowstring::testing {

using OwnedEnforcement = std::unique_ptr<Enforcement, Destructor>;

inline OwnedEnforcement enforcement_plugin(const char* name, const std::function<void(const SetParameter&)>& set = {}) {
  Status status;
  const ComponentDescriptor* component = plugin_host().find(Kind::enforcement, name, status);
  REQUIRE_MESSAGE(component != nullptr, status.text);
  ParameterSet parameters = default_parameters(*component);
  const SetParameter value = [&](const char* key, ParameterType type) -> ParameterValue& {
    for (ParameterValue& found : parameters.values) {
      if (found.key == key) return found;
    }
    parameters.values.emplace_back();
    parameters.values.back().key = key;
    parameters.values.back().type = type;
    return parameters.values.back();
  };
  if (set) set(value);
  void* raw = nullptr;
  status = component->create(parameters, &raw);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return OwnedEnforcement(static_cast<Enforcement*>(raw), component->destroy);
}

inline Answer solve_around(Enforcement& enforcement, Solver& solver, Problem& problem, const std::vector<double>& start,
                           const std::function<bool(const IterationRecord&)>& progress = {},
                           const std::vector<double>& multipliers = {}) {
  Answer answer;
  SolverContext context;
  context.on_iteration = progress;
  context.multipliers = multipliers;
  answer.status = enforcement.solve(problem, solver, start, context, answer.result);
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  return answer;
}

inline OwnedSolver plain_solver(const char* name) {
  return solver_plugin(name, [](const SetParameter&) {});
}

/// Largest difference of two lists of numbers, relative to the largest number of the second one.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  const double size = largest(b);
  REQUIRE(size > 0.0);
  return largest_difference(a, b) / size;
}

}  // namespace bowstring::testing
