#include "core/interfaces/transport.hpp"
#include "losses/transport/network-simplex/dense_costs.hpp"
#include "losses/transport/network-simplex/exact_answer.hpp"
#include "losses/transport/network-simplex/network_simplex.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;

/// A vertex of the optimal plans by our own network simplex. It keeps its tree from call to call.
class Exact final : public Transport {
 public:
  explicit Exact(const ParameterSet&) {}

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    const Status status = guard([&] { solve_or_throw(problem, out); });
    if (!status.ok()) forget();
    return status;
  }
  void forget() noexcept override { simplex_.forget(); }

 private:
  void solve_or_throw(const TransportProblem& problem, TransportAnswer& out) {
    costs_.load_bounds(*problem.between);
    simplex_.set_masses(simplex::masses_of(problem.weight_a, problem.weight_b));
    out = {};
    out.warm = simplex_.has_tree();
    // Potentials of costs that are partly lower bounds are feasible, and they prove the plan as soon as its own arcs
    // have their costs.
    do {
      if (!simplex_.solve(costs_.data())) simplex::refuse_forbidden(simplex_.plan(), costs_.data(), simplex_.masses());
      out.iterations += simplex_.pivots();
    } while (costs_.evaluate(simplex_.plan()) > 0);
    simplex::write_answer(problem, costs_.data(), simplex_.masses(),
                          {simplex_.basis(), simplex_.row_potential(), simplex_.column_potential(), simplex_.barrier()},
                          out);
    out.memory_bytes = simplex_.memory_bytes() + costs_.memory_bytes();
  }

  simplex::NetworkSimplex simplex_;
  simplex::DenseCosts costs_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, Exact>(
    bowstring::Kind::transport, "exact",
    "An optimal plan by network simplex, with its proof; goes on from the plan of the call before"))
