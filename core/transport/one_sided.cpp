#include "core/transport/one_sided.hpp"

#include <cmath>
#include <cstddef>

#include "core/transport/pair_costs.hpp"

namespace bowstring {
namespace {

/// Reduced costs up to here, relative to the certificate's scale, count as zero.
constexpr double tight = 1e-9;

/// The pairs (i, j) without reduced cost.
Status tight_pairs(const GroundCost& cost, const Measure& a, const Measure& b, const TransportAnswer& answer,
                   std::vector<int>& pairs) {
  const std::size_t rows = a.count(), columns = b.count();
  std::vector<double> value(columns);
  const double tolerance = tight * answer.certificate.cost_scale;
  for (std::size_t i = 0; i < rows; ++i) {
    const int row = static_cast<int>(i);
    const Status status = cost.rows(a, b, row, row + 1, value);
    if (!status.ok()) return status;
    for (std::size_t j = 0; j < columns; ++j) {
      if (value[j] - answer.dual_a[i] - answer.dual_b[j] <= tolerance)
        pairs.insert(pairs.end(), {row, static_cast<int>(j)});
    }
  }
  return {};
}

double along(const double* gradient, const double* twist) {
  double sum = 0.0;
  for (int e = 0; e < 6; ++e) sum += gradient[e] * twist[e];
  return sum;
}

/// The rates of cost of these pairs.
Status cost_rates(const GroundCost& cost, const Measure& a, const Measure& b, const std::vector<int>& pairs,
                  Span<const double> motion_a, Span<const double> motion_b, std::vector<double>& rate) {
  const std::size_t count = pairs.size() / 2;
  std::vector<int> swapped(pairs.size());
  for (std::size_t k = 0; k < count; ++k) {
    swapped[2 * k] = pairs[2 * k + 1];
    swapped[2 * k + 1] = pairs[2 * k];
  }
  std::vector<double> value(count), by_a(6 * count), by_b(6 * count);
  Status status = cost.evaluate(a, b, pairs, value, by_a);
  if (status.ok()) status = cost.evaluate(b, a, swapped, value, by_b);
  if (!status.ok()) return status;
  rate.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    rate[k] = along(&by_a[6 * k], motion_a.data() + 6 * pairs[2 * k]) +
              along(&by_b[6 * k], motion_b.data() + 6 * pairs[2 * k + 1]);
  }
  return {};
}

/// min over plans on these pairs of ⟨sign · rate, γ⟩, times the sign.
Status extreme(const TransportChoice& choice, const Measure& a, const Measure& b, const std::vector<int>& pairs,
               const std::vector<double>& rate, double sign, double& out) {
  std::vector<double> cost(a.count() * b.count(), HUGE_VAL);
  for (std::size_t k = 0; k < rate.size(); ++k) {
    cost[static_cast<std::size_t>(pairs[2 * k]) * b.count() + static_cast<std::size_t>(pairs[2 * k + 1])] =
        sign * rate[k];
  }
  Status status;
  std::optional<TransportComparison> face = TransportComparison::open(choice, status);
  if (!face) return status;
  TransportResult result;
  status = face->compare(a.weight, b.weight, cost, result);
  out = sign * result.answer.value;
  return status;
}

}  // namespace

Status one_sided_derivatives(const TransportComparison& comparison, const Measure& a, const Measure& b,
                             const TransportResult& at, Span<const double> motion_a, Span<const double> motion_b,
                             OneSidedDerivatives& out) {
  if (!at.answer.uniqueness_known) {
    return Status::failure(Code::unsupported, "transport '" + comparison.choice().method.name +
                                                  "' does not find vertices of the optimal plans; choose 'exact'");
  }
  if (comparison.lets_mass_go()) {
    return Status::failure(Code::unsupported, "transport '" + comparison.choice().method.name +
                                                  "' lets mass go, and its optimal plans are not those of fixed sums; "
                                                  "choose 'exact'");
  }
  if (motion_a.size() != 6 * a.count() || motion_b.size() != 6 * b.count()) {
    return Status::failure(Code::invalid_input, "motions of " + std::to_string(motion_a.size()) + " and " +
                                                    std::to_string(motion_b.size()) +
                                                    " numbers; expected six for each place");
  }
  std::vector<int> pairs;
  std::vector<double> rate;
  Status status = tight_pairs(comparison.ground_cost(), a, b, at.answer, pairs);
  if (status.ok()) status = cost_rates(comparison.ground_cost(), a, b, pairs, motion_a, motion_b, rate);
  if (status.ok()) status = extreme(comparison.choice(), a, b, pairs, rate, 1.0, out.after);
  if (status.ok()) status = extreme(comparison.choice(), a, b, pairs, rate, -1.0, out.before);
  return status;
}

}  // namespace bowstring
