#pragma once

#include <string>

#include "core/model/scene.hpp"

namespace bowstring {

// What plugins declare is taken at its word by the assembly's loops, so it is checked once, here. Each answers "" or
// what is wrong, as the end of a sentence: "declares 2 laws with 1 descriptions".

std::string flaw_of(const CurveGeometry& geometry, int dimension);

/// `parameters`: the energy's, whose keys its laws read.
std::string flaw_of(const EnergyDeclaration& declaration, const ParameterSet& parameters);

/// `unknowns`: of the curve, over all fields.
std::string flaw_of(const KinematicsDeclaration& declaration, int unknowns);

std::string flaw_of(const RowDeclaration& rows);

/// The solver's answer against the problem's sizes.
std::string flaw_of(const SolverResult& result, const Problem& problem);

}  // namespace bowstring
