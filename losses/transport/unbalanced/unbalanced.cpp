#include <string>

#include "core/interfaces/transport.hpp"
#include "losses/transport/unbalanced/kullback_leibler.hpp"
#include "losses/transport/unbalanced/total_variation.hpp"
#include "plugins/sdk/plugin.hpp"

namespace {

using namespace bowstring;

constexpr ParameterDeclaration schema[] = {
    {"penalty", ParameterType::choice, "", "\"kl\"",
     "what sums of the plan that are not the weights cost: their Kullback-Leibler divergence, smoothly, or the mass "
     "that is missing, so that pairs dearer than twice the marginal weight are given up",
     -1e308, 1e308, false, false, "kl|total-variation"},
    {"marginal-weight", ParameterType::scalar, "", nullptr,
     "rho, the weight of the penalty on either side, a number in the unit of the cost (mm^2 under 'euclidean')", 0.0,
     1e308, true},
    {"epsilon", ParameterType::scalar, "", "0.0",
     "the weight of the plan's own divergence from the product of the weights, in the unit of the cost; of 'kl' alone",
     0.0},
};

/// Transport that may lose and make mass.
class Unbalanced final : public Transport {
 public:
  explicit Unbalanced(const ParameterSet& parameters)
      : vanishes_(parameters.text("penalty") == "total-variation"),
        weight_(parameters.scalar("marginal-weight")),
        epsilon_(parameters.scalar("epsilon")) {
    if (!vanishes_ || epsilon_ == 0.0) return;
    throw StatusError(Code::invalid_input,
                      "'epsilon' above 0 with penalty = \"total-variation\", which is a linear program; expected 0; "
                      "leave epsilon out, or choose penalty = \"kl\"");
  }

  Status solve(const TransportProblem& problem, TransportAnswer& out) noexcept override {
    const Status status = guard([&] {
      if (vanishes_) {
        total_variation_.solve(problem, weight_, out);
      } else {
        unbalanced::solve_kullback_leibler(problem, weight_, epsilon_, out);
      }
    });
    if (!status.ok()) forget();
    return status;
  }
  bool lets_mass_go() const noexcept override { return true; }
  void forget() noexcept override { total_variation_.forget(); }

 private:
  bool vanishes_;
  double weight_, epsilon_;
  unbalanced::TotalVariation total_variation_;
};

}  // namespace

BOWSTRING_PLUGIN(bowstring::component<bowstring::Transport, Unbalanced>(
    bowstring::Kind::transport, "unbalanced",
    "Transport between measures of any masses: what is lost or made costs a penalty", schema))
