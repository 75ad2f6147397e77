#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/transport/transport_comparison.hpp"
#include "plugins/host/plugin_host.hpp"

// solve-transport-problems IN OUT: solves what IN lists and writes the answers, for comparisons with other programs.
//   IN:  [{"method", "settings": {key: text}, "weight_a", "weight_b", "cost": rows × columns | "position_a",
//          "position_b": count × 3}, …]
//   OUT: [{"status", "value", "transport_cost", "gap", "row", "column", "mass", "iterations", "figures"}, …]

namespace {

using namespace bowstring;
using nlohmann::json;

Status solve(TransportComparison& transport, const json& problem, TransportResult& out) {
  const auto a = problem.at("weight_a").get<std::vector<double>>(),
             b = problem.at("weight_b").get<std::vector<double>>();
  if (problem.contains("cost")) return transport.compare(a, b, problem.at("cost").get<std::vector<double>>(), out);
  const Measure first{problem.at("position_a").get<std::vector<double>>(), {}, a};
  const Measure second{problem.at("position_b").get<std::vector<double>>(), {}, b};
  return transport.compare(first, second, out);
}

json answer_to(const json& problem, Registry& registry) {
  TransportRequest request;
  request.method = problem.at("method");
  for (const auto& [key, value] : problem.at("settings").items()) {
    request.settings.push_back({key, value.get<std::string>(), "", ""});
  }
  Refusal refusal;
  std::optional<TransportComparison> transport = TransportComparison::open(request, registry, refusal);
  if (!transport) return {{"status", refusal.text()}};
  TransportResult result;
  const Status status = solve(*transport, problem, result);
  if (!status.ok()) return {{"status", status.text}};
  const TransportAnswer& answer = result.answer;
  json figures;
  for (const auto& [name, value] : answer.figures) figures[name] = value;
  return {{"status", ""},
          {"value", answer.value},
          {"transport_cost", answer.transport_cost},
          {"gap", answer.gap},
          {"row", answer.plan.row},
          {"column", answer.plan.column},
          {"mass", answer.plan.value},
          {"iterations", answer.iterations},
          {"seconds", result.solve_seconds},
          {"figures", figures}};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: solve-transport-problems IN OUT\n", stderr);
    return 2;
  }
  try {
    std::ifstream in(arguments[1]);
    PluginHost plugins;
    json answers = json::array();
    for (const json& problem : json::parse(in)) answers.push_back(answer_to(problem, plugins));
    std::ofstream(arguments[2]) << answers;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
