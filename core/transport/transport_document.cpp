#include "core/transport/transport_document.hpp"

#include <numeric>
#include <utility>

#include "core/composition/resolved.hpp"
#include "core/transport/transport_json.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

Json known(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json side_json(const TransportSide& side) {
  return {{"name", known(side.name)},
          {"kind", side.is_curve ? "curve" : "places"},
          {"s_mm", numbers_or_null(side.arc)},
          {"positions", rows_or_null(side.measure.position, 3)},
          {"orientations", rows_or_null(side.measure.orientation, 4)},
          {"weights", numbers_or_null(side.measure.weight)}};
}

Json spread_json(const Spread& spread) {
  return {{"median", spread.median}, {"min", spread.least}, {"max", spread.most}};
}

Json repeat_json(const std::optional<RepeatRecord>& repeat) {
  if (!repeat) return nullptr;
  return {{"count", repeat->count},
          {"seed", repeat->seed},
          {"step_mm", repeat->step},
          {"seconds", {{"warm", spread_json(repeat->warm)}, {"cold", spread_json(repeat->cold)}}},
          {"iterations", {{"warm", spread_json(repeat->iterations)}, {"cold", spread_json(repeat->cold_iterations)}}}};
}

Json provenance_with_inputs(const TransportReport& report) {
  Json out = report.provenance.empty() ? Json::object() : Json::parse(report.provenance);
  out["inputs"] = Json::array();
  for (const TransportSide* side : {&report.a, &report.b}) {
    out["inputs"].push_back({{"file", known(side->file)}, {"sha256", known(side->sha256)}});
  }
  return out;
}

}  // namespace

std::string transport_document(const TransportReport& report) {
  const std::vector<double>& weight = report.a.measure.weight;
  const TransportResult& result = report.result;
  Json document;
  document["format"] = transport_format;
  document["method"] = Json::parse(component_json(report.choice.method));
  document["ground_cost"] = Json::parse(component_json(report.choice.cost));
  document.update(transport_answer_json(result, std::accumulate(weight.begin(), weight.end(), 0.0)));
  document["gradient"] = {{"positions_a", rows_or_null(result.gradient_a.position, 3)},
                          {"positions_b", rows_or_null(result.gradient_b.position, 3)},
                          {"frames_a", rows_or_null(result.gradient_a.frame, 6)},
                          {"frames_b", rows_or_null(result.gradient_b.frame, 6)},
                          {"weights_a", numbers_or_null(result.answer.weight_gradient_a)},
                          {"weights_b", numbers_or_null(result.answer.weight_gradient_b)}};
  document["seconds"] = {{"read", report.read_seconds}, {"cost", result.cost_seconds}, {"solve", result.solve_seconds}};
  document["repeat"] = repeat_json(report.repeat);
  document["a"] = side_json(report.a);
  document["b"] = side_json(report.b);
  document["provenance"] = provenance_with_inputs(report);
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bowstring
