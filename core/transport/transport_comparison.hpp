#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/ground_cost.hpp"
#include "core/interfaces/transport.hpp"
#include "core/model/component.hpp"
#include "core/session/refusal.hpp"
#include "core/transport/place_gradient.hpp"

namespace bowstring {

/// A transport method and a ground cost by their names.
struct TransportRequest {
  std::string method = "exact";
  std::string cost = "euclidean";
  /// Keys that the method or the cost declares: {"forward-weight", "0.1 1/mm"}; values are TOML, or text.
  std::vector<Override> settings;
};

/// The two plugins with their checked parameters.
struct TransportChoice {
  ComponentChoice method, cost;
};

/// Looks a request up. Empty where anything is wrong with it: all of it is in `refusal`.
std::optional<TransportChoice> choose_transport(const TransportRequest& request, Registry& registry, Refusal& refusal);

/// What came of one comparison.
struct TransportResult {
  TransportAnswer answer;
  PlaceGradient gradient_a, gradient_b;  ///< empty where costs were given as a matrix
  std::string cost_unit;                 ///< "mm^2", or "": the unit of values
  long costs_evaluated = 0;
  double cost_seconds = 0.0;   ///< in the ground cost, ahead of the solve; 0 where pairs are evaluated as they matter
  double solve_seconds = 0.0;  ///< in the method, with the pairs that it asks for
};

/// Optimal transport between measures, one after the other: points and weights and a cost go in, value, plan, duals,
/// gradient and certificate come out. It keeps what its method keeps, above all the basis of the plan before: measures
/// that have moved a little since then take a fraction of the time. `forget` makes the next comparison a cold one.
///
///   bowstring::PluginHost plugins;
///   bowstring::Refusal refusal;
///   auto transport = bowstring::TransportComparison::open({"exact", "euclidean", {}}, plugins, refusal);
///   if (!transport) std::puts(refusal.text().c_str());
///   bowstring::TransportResult result;
///   const bowstring::Status status = transport->compare(predicted, observed, result);
///   const double squared_distance = result.answer.value;  // mm²
///
/// One object serves one thread at a time; different objects are independent.
class TransportComparison {
 public:
  /// Empty, with everything that is wrong in `refusal`, where a name or a setting is unknown or does not fit.
  static std::optional<TransportComparison> open(const TransportRequest& request, Registry& registry, Refusal& refusal);
  /// From what a composition has chosen. Empty with `status` where a plugin's factory fails.
  static std::optional<TransportComparison> open(const TransportChoice& choice, Status& status);

  /// Places, weights, the choice's ground cost. `invalid_input`: a measure is flawed, sums of weights differ by more
  /// than 1e-9 of them under a method that keeps mass, or the cost needs frames; the text names measure and index.
  /// `unsupported`: the method cannot take this cost. `with_gradient` false spares the derivatives by places.
  Status compare(const Measure& a, const Measure& b, TransportResult& out, bool with_gradient = true);

  /// Costs that the user has computed: weight_a.size() × weight_b.size(), row major, not NaN; +∞ forbids a pair. Of
  /// the ground cost nothing is used, and there are no derivatives by places.
  Status compare(Span<const double> weight_a, Span<const double> weight_b, Span<const double> cost,
                 TransportResult& out);

  /// What `compare` would refuse of these measures before it computes anything.
  Status check(const Measure& a, const Measure& b) const;

  void forget() noexcept { method_->forget(); }
  const TransportChoice& choice() const noexcept { return choice_; }
  bool lets_mass_go() const noexcept { return method_->lets_mass_go(); }
  const GroundCost& ground_cost() const noexcept { return *cost_; }

 private:
  TransportComparison(TransportChoice choice, Owned<Transport> method, Owned<GroundCost> cost);

  TransportChoice choice_;
  Owned<Transport> method_;
  Owned<GroundCost> cost_;
};

}  // namespace bowstring
