#include <cmath>

#include <nlohmann/json.hpp>

#include "apps/compare_report.hpp"

namespace bowstring::apps {

namespace {

using Json = nlohmann::ordered_json;

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json optional(const std::optional<std::string>& value) { return value ? Json(*value) : Json(nullptr); }

Json known(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json side(const ComparedSide& side) {
  return {{"file", side.file}, {"form", side.is_result ? "result" : "composition"}};
}

Json word(const WordDifference& difference) { return {{"a", known(difference.a)}, {"b", known(difference.b)}}; }

Json number(const NumberDifference& one) {
  return {{"a", finite(one.a)},
          {"b", finite(one.b)},
          {"absolute", finite(one.absolute())},
          {"relative", finite(one.relative())}};
}

Json numbers(const std::vector<NumberDifference>& all) {
  Json out = Json::object();
  for (const NumberDifference& one : all) out[one.path] = number(one);
  return out;
}

Json curves(const std::vector<CurveDifference>& all) {
  Json out = Json::array();
  for (const CurveDifference& one : all) {
    const bool found = one.unknown.empty();
    out.push_back({{"name", one.name},
                   {"nodes", found ? Json{{"a", one.nodes_a}, {"b", one.nodes_b}} : Json(nullptr)},
                   {"largest_mm", found ? finite(one.largest) : Json(nullptr)},
                   {"largest_at_material_share", found ? finite(one.largest_share) : Json(nullptr)},
                   {"mean_mm", found ? finite(one.mean) : Json(nullptr)},
                   {"unknown", known(one.unknown)}});
  }
  return out;
}

Json results(const ResultDifferences& found) {
  return {{"same_bits", found.bits.same()},
          {"numbers_compared", found.bits.numbers},
          {"numbers_different", found.bits.different.size()},
          {"otherwise", found.bits.otherwise},
          {"status", word(found.status)},
          {"reason", word(found.reason)},
          {"second_order", word(found.second_order)},
          {"quantities", numbers(found.quantities)},
          {"energy", numbers(found.energies)},
          {"losses", numbers(found.losses)},
          {"certificate", numbers(found.certificate)},
          {"curves", curves(found.curves)},
          {"forces_N", numbers(found.forces)},
          {"effort", numbers(found.effort)},
          {"seconds", numbers(found.seconds)}};
}

}  // namespace

std::string json_text(const CompareReport& report) {
  Json composition = Json::array();
  for (const CompositionDifference& one : report.questions.composition) {
    composition.push_back(
        {{"path", one.path}, {"a", optional(one.a)}, {"b", optional(one.b)}, {"because_of", known(one.because_of)}});
  }
  const Json document = {{"format", "bowstring.compare/1"},
                         {"a", side(report.a)},
                         {"b", side(report.b)},
                         {"differs", report.anything_differs()},
                         {"things", report.questions.things()},
                         {"warning", known(report.warning)},
                         {"composition", std::move(composition)},
                         {"provenance", report.questions.provenance},
                         {"results", report.results ? results(*report.results) : Json(nullptr)}};
  return document.dump(1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace bowstring::apps
