#include "core/transport/transport_json.hpp"

#include <cmath>

#include "core/transport/certificate.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

Json certificate_json(const TransportAnswer& answer, double mass) {
  if (!answer.certified) return nullptr;
  const TransportCertificate& certificate = answer.certificate;
  return {{"holds", certificate_holds(certificate, mass)},
          {"marginal_a", finite_or_null(certificate.marginal_a)},
          {"marginal_b", finite_or_null(certificate.marginal_b)},
          {"dual_violation", finite_or_null(certificate.dual_violation)},
          {"gap", finite_or_null(certificate.gap)},
          {"cost_scale", finite_or_null(certificate.cost_scale)}};
}

}  // namespace

nlohmann::ordered_json finite_or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

nlohmann::ordered_json numbers_or_null(const std::vector<double>& numbers) { return rows_or_null(numbers, 1); }

nlohmann::ordered_json rows_or_null(const std::vector<double>& numbers, std::size_t per_row) {
  if (numbers.empty()) return nullptr;
  Json out = Json::array();
  for (std::size_t i = 0; i + per_row <= numbers.size(); i += per_row) {
    if (per_row == 1) {
      out.push_back(finite_or_null(numbers[i]));
      continue;
    }
    Json row = Json::array();
    for (std::size_t k = 0; k < per_row; ++k) row.push_back(finite_or_null(numbers[i + k]));
    out.push_back(std::move(row));
  }
  return out;
}

nlohmann::ordered_json transport_answer_json(const TransportResult& result, double mass) {
  const TransportAnswer& answer = result.answer;
  Json figures = Json::object();
  for (const auto& [name, value] : answer.figures) figures[name] = finite_or_null(value);
  return {{"value", finite_or_null(answer.value)},
          {"unit", result.cost_unit},
          {"transport_cost", finite_or_null(answer.transport_cost)},
          {"plan", {{"row", answer.plan.row}, {"column", answer.plan.column}, {"mass", answer.plan.value}}},
          {"duals", {{"a", numbers_or_null(answer.dual_a)}, {"b", numbers_or_null(answer.dual_b)}}},
          {"certificate", certificate_json(answer, mass)},
          {"gap", finite_or_null(answer.gap)},
          {"unique", answer.uniqueness_known ? Json(!answer.multiple) : Json(nullptr)},
          {"slack", answer.uniqueness_known ? finite_or_null(answer.slack) : Json(nullptr)},
          {"iterations", answer.iterations},
          {"warm", answer.warm},
          {"memory_bytes", answer.memory_bytes},
          {"costs_evaluated", result.costs_evaluated},
          {"figures", std::move(figures)}};
}

}  // namespace bowstring
