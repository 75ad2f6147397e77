#pragma once

#include <vector>

#include "core/interfaces/transport.hpp"
#include "losses/transport/network-simplex/masses.hpp"
#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// What a simplex method found: a vertex of the plans, and potentials.
struct Vertex {
  std::vector<Arc> basis;           ///< arcs that form no cycle, all those with mass among them
  std::vector<double> row, column;  ///< potentials, one per place
  double barrier;                   ///< costs from here on are out of all proportion and not in the plan; else +∞
};

/// Writes value, plan, duals and gradients, and judges them: certificate, uniqueness and slack are computed from
/// weights, `cost` (rows × columns, row major; of dear costs lower bounds off the plan) and the vertex.
///
/// Uniqueness: another optimal plan exists where the graph of arcs from rows to columns without reduced cost, and from
/// columns to rows with mass, has a cycle other than there and back. What reduced cost counts as none: up to 1e-12 of
/// the certificate's `cost_scale`.
void write_answer(const TransportProblem& problem, const double* cost, const Masses& masses, const Vertex& vertex,
                  TransportAnswer& out);

/// Throws the StatusError of a plan that cannot do without forbidden pairs.
[[noreturn]] void refuse_forbidden(const std::vector<Arc>& plan, const double* cost, const Masses& masses);

}  // namespace bowstring::simplex
