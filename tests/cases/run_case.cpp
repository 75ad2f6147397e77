// Runs one case file: compositions with overrides, and what their results must show.
//
//   composition = "../../scenes/planar-iliac.toml"
//   data = "vmr_0110/left_smoothed_200.csv"     # skipped, visibly, where BOWSTRING_DATA is unset; {data} in values
//   [[run]]
//   name   = "N = 40"
//   full   = true                                # only in the full test
//   composition = "other.toml"                   # another one for this run
//   set    = { "vessel.iliac.geometry.nodes" = "40" }        # TOML texts, as after --set
//   expect = { "quantities.peak_displacement_mm" = { value = 13.10, relative = 0.01 },
//              "solver.iterations" = { at-most = 25 }, "status" = { is = "converged" } }
//   [[agree]]  runs = ["a", "b"], path = "energy.total", relative = 1e-8
//   [[order]]  runs = ["N = 20", "N = 40", …], steps = [19, 39, …], path = "energy.total", least = 1.9, most = 2.2,
//              limit = 112.1, relative = 0.003     # limit 0: the values themselves are errors; minus = [runs]: of
//              differences
//   [[slope]]  runs = ["a", "b"], between = [0.999, 1.001], path = "curves.0.points.-1.1", value = 24.8, relative =
//   1e-5
//              (or equals = { "supports.0.force_N.0" = 1.0, … }: a combination, the mean of both runs)
//
// Paths address the result document; entries of lists by number, negative from the end. Prints a table and ends with "N
// passed, N failed, N skipped".

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include "core/procedure/procedure.hpp"
#include "core/result/document.hpp"
#include "plugins/host/plugin_host.hpp"

namespace {

using Json = nlohmann::json;

struct Tally {
  int passed = 0, failed = 0, skipped = 0;
  void check(bool good, const std::string& text) {
    std::printf("  %s  %s\n", good ? "pass" : "FAIL", text.c_str());
    (good ? passed : failed) += 1;
  }
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.8g", value);
  return text;
}

const Json* lookup(const Json& document, const std::string& path) {
  const Json* at = &document;
  std::size_t begin = 0;
  while (begin <= path.size()) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string key = path.substr(begin, end - begin);
    if (at->is_array()) {
      const long index = std::strtol(key.c_str(), nullptr, 10);
      const auto size = static_cast<long>(at->size());
      if (index >= size || index < -size) return nullptr;
      at = &(*at)[static_cast<std::size_t>(index < 0 ? size + index : index)];
    } else {
      if (!at->is_object() || !at->contains(key)) return nullptr;
      at = &(*at)[key];
    }
    begin = end + 1;
  }
  return at;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

void expect(const Json& document, const std::string& run, const std::string& path, const toml::table& wanted,
            Tally& tally) {
  const std::string name = run + ": " + path;
  const Json* found = lookup(document, path);
  if (found == nullptr) return tally.check(false, name + " is not in the result");
  if (const auto text = wanted["is"].value<std::string>()) {
    const std::string value = found->is_string() ? found->get<std::string>() : found->dump();
    return tally.check(value == *text, name + " = " + value + ", expected " + *text);
  }
  if (const auto text = wanted["contains"].value<std::string>()) {
    const std::string value = found->dump();
    return tally.check(value.find(*text) != std::string::npos,
                       name + " contains '" + *text + "': " + value.substr(0, 300));
  }
  if (!found->is_number()) return tally.check(false, name + " is not a number: " + found->dump());
  const double value = found->get<double>();
  if (const auto target = wanted["value"].value<double>()) {
    const double tolerance = wanted["relative"].value<double>()
                                 ? *wanted["relative"].value<double>() * std::fabs(*target)
                                 : wanted["absolute"].value_or(0.0);
    tally.check(std::fabs(value - *target) <= tolerance,
                name + " = " + number(value) + ", expected " + number(*target) + " ± " + number(tolerance));
  }
  if (const auto most = wanted["at-most"].value<double>()) {
    tally.check(value <= *most, name + " = " + number(value) + ", at most " + number(*most));
  }
  if (const auto least = wanted["at-least"].value<double>()) {
    tally.check(value >= *least, name + " = " + number(value) + ", at least " + number(*least));
  }
}

/// Solves and returns the document; null where the composition is refused.
Json solve(const std::string& file, const toml::table& run, const std::string& data) {
  bowstring::CompositionRequest request;
  request.file = file;
  if (const toml::table* set = run["set"].as_table()) {
    for (const auto& [path, value] : *set) {
      request.overrides.push_back({std::string(path.str()), replaced(value.value_or(std::string()), "{data}", data)});
    }
  }
  bowstring::PluginHostOptions options;
  const char* build = std::getenv("BOWSTRING_BUILD_ROOT");
  options.executable_path = (build == nullptr ? std::string("build") : std::string(build)) + "/bowstring";
  bowstring::PluginHost host(options);
  bowstring::Refusal refusal;
  const auto procedure = bowstring::Procedure::prepare(request, host, refusal);
  if (procedure == nullptr) {
    for (const bowstring::InputError& error : refusal.errors) std::printf("  refused: %s\n", error.text().c_str());
    if (!refusal.plugin_failure.ok()) std::printf("  refused: %s\n", refusal.plugin_failure.text.c_str());
    return nullptr;
  }
  const std::vector<bowstring::StateResult> states = procedure->run({});
  if (!states.back().readable.ok()) std::printf("  %s\n", states.back().readable.text.c_str());
  return Json::parse(bowstring::result_document(states));
}

/// Slope of log(error) over log(1/step), by least squares; errors are differences to the limit that makes the fit best.
struct Fit {
  double order = 0.0, limit = 0.0, misfit = 0.0;
};

Fit fit_line(const std::vector<double>& h, const std::vector<double>& value, double limit) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  const auto n = static_cast<double>(h.size());
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double x = std::log(h[i]);
    const double y = std::log(std::fabs(value[i] - limit));
    sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  Fit fit;
  fit.limit = limit;
  fit.order = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  fit.misfit = syy - sy * sy / n - fit.order * (sxy - sx * sy / n);
  return fit;
}

/// The limit is searched beyond the finest value, on the side toward which the values run.
Fit fit_order(const std::vector<double>& h, const std::vector<double>& value) {
  const double last = value.back();
  const double run = last - value[value.size() - 2];
  Fit best;
  best.misfit = 1e300;
  for (int k = 1; k <= 4000; ++k) {
    const Fit fit = fit_line(h, value, last + run * (k / 2000.0));
    if (fit.misfit < best.misfit) best = fit;
  }
  return best;
}

std::vector<std::string> names(const toml::table& table, const char* key = "runs") {
  std::vector<std::string> out;
  for (const auto& node : *table[key].as_array()) out.push_back(node.value_or(std::string()));
  return out;
}

/// Values of a path in the named runs; empty where one of them was skipped or has no number.
std::vector<double> gather(const std::map<std::string, Json>& results, const toml::table& table,
                           const std::string& path, const char* runs = "runs") {
  std::vector<double> out;
  for (const std::string& name : names(table, runs)) {
    const auto found = results.find(name);
    const Json* value = found == results.end() ? nullptr : lookup(found->second, path);
    if (value == nullptr || !value->is_number()) return {};
    out.push_back(value->get<double>());
  }
  return out;
}

void check_agreement(const std::map<std::string, Json>& results, const toml::table& table, Tally& tally) {
  const std::string path = table["path"].value_or(std::string());
  const std::vector<double> values = gather(results, table, path);
  if (values.empty()) return void(++tally.skipped);
  const double relative = table["relative"].value_or(0.0);
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::fabs(value / values.front() - 1.0));
  tally.check(values.front() != 0.0 && largest <= relative, path + " of " + std::to_string(values.size()) +
                                                                " runs agrees to " + number(largest) + ", expected " +
                                                                number(relative));
}

void check_order(const std::map<std::string, Json>& results, const toml::table& table, Tally& tally) {
  const std::string path = table["path"].value_or(std::string());
  std::vector<double> values = gather(results, table, path);
  if (values.size() < 4) return void(++tally.skipped);
  if (table.contains("minus")) {
    const std::vector<double> others = gather(results, table, path, "minus");
    if (others.size() != values.size()) return void(++tally.skipped);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= others[i];
  }
  std::vector<double> h;
  for (const auto& node : *table["steps"].as_array()) h.push_back(1.0 / node.value_or(1.0));
  const bool to_zero = table["limit"].value<double>() == 0.0;
  const Fit fit = to_zero ? fit_line(h, values, 0.0) : fit_order(h, values);
  tally.check(fit.order >= table["least"].value_or(0.0) && fit.order <= table["most"].value_or(1e9),
              path + " converges with order " + number(fit.order) + " over " + std::to_string(values.size()) +
                  " meshes to " + number(fit.limit));
  if (const auto limit = table["limit"].value<double>(); limit && !to_zero) {
    tally.check(std::fabs(fit.limit / *limit - 1.0) <= table["relative"].value_or(0.0),
                path + " has limit " + number(fit.limit) + ", expected " + number(*limit));
  }
}

/// A combination of paths, averaged over the named runs.
std::vector<double> mean_of_combination(const std::map<std::string, Json>& results, const toml::table& table,
                                        const toml::table& factors) {
  double sum = 0.0;
  for (const auto& [path, factor] : factors) {
    const std::vector<double> values = gather(results, table, std::string(path.str()));
    if (values.empty()) return {};
    for (const double value : values) {
      sum += factor.value_or(0.0) * value / static_cast<double>(values.size());
    }
  }
  return {sum};
}

void check_slope(const std::map<std::string, Json>& results, const toml::table& table, Tally& tally) {
  const std::string path = table["path"].value_or(std::string());
  const std::vector<double> values = gather(results, table, path);
  std::vector<double> expected{table["value"].value_or(0.0)};
  if (const toml::table* equals = table["equals"].as_table()) expected = mean_of_combination(results, table, *equals);
  if (values.size() != 2 || expected.empty()) return void(++tally.skipped);
  const toml::array& between = *table["between"].as_array();
  const double slope = (values[1] - values[0]) / (between[1].value_or(0.0) - between[0].value_or(0.0));
  const double error = std::fabs(slope / expected.front() - 1.0);
  tally.check(error <= table["relative"].value_or(0.0),
              "slope of " + path + " between " + names(table).front() + " and " + names(table).back() + " = " +
                  number(slope) + ", expected " + number(expected.front()) + ", off by " + number(error));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: run-case FILE\n"), 2;
  const std::filesystem::path case_file = argv[1];
  const toml::table table = toml::parse_file(case_file.string());
  const auto composition_of = [&](const toml::table& run) {
    const std::string common = table["composition"].value_or(std::string());
    return (case_file.parent_path() / run["composition"].value_or(common)).string();
  };
  const bool full = std::getenv("BOWSTRING_TEST_FULL") != nullptr;
  std::string data;
  Tally tally;
  if (table.contains("data")) {
    const char* folder = std::getenv("BOWSTRING_DATA");
    data = folder == nullptr ? "" : std::string(folder) + "/" + table["data"].value_or(std::string());
    if (folder == nullptr || !std::filesystem::exists(data)) {
      std::printf("skipped: BOWSTRING_DATA names no folder with %s\n0 passed, 0 failed, 1 skipped\n",
                  table["data"].value_or(""));
      return 77;
    }
  }
  std::map<std::string, Json> results;
  for (const auto& node : *table["run"].as_array()) {
    const toml::table& run = *node.as_table();
    const std::string name = run["name"].value_or(std::string());
    if (run["full"].value_or(false) && !full) {
      ++tally.skipped;
      continue;
    }
    const Json document = solve(composition_of(run), run, data);
    if (document.is_null()) {
      tally.check(false, name + ": refused");
      continue;
    }
    const Json& q = document["quantities"];
    std::printf("%s: %s in %d iterations, %.3f s; total %s, peak %s, wire %s, contacts %s, force %s\n", name.c_str(),
                document["status"].get<std::string>().c_str(), document["solver"]["iterations"].get<int>(),
                document["solver"]["seconds"]["total"].get<double>(), document["energy"]["total"].dump().c_str(),
                q["peak_displacement_mm"].dump().c_str(), q["wire_length_mm"].dump().c_str(),
                q["contact_count"].dump().c_str(), q["contact_force_N"].dump().c_str());
    if (const toml::table* expected = run["expect"].as_table()) {
      for (const auto& [path, wanted] : *expected)
        expect(document, name, std::string(path.str()), *wanted.as_table(), tally);
    }
    results[name] = document;
  }
  if (const toml::array* list = table["agree"].as_array()) {
    for (const auto& node : *list) check_agreement(results, *node.as_table(), tally);
  }
  if (const toml::array* list = table["order"].as_array()) {
    for (const auto& node : *list) check_order(results, *node.as_table(), tally);
  }
  if (const toml::array* list = table["slope"].as_array()) {
    for (const auto& node : *list) check_slope(results, *node.as_table(), tally);
  }
  std::printf("%d passed, %d failed, %d skipped\n", tally.passed, tally.failed, tally.skipped);
  return tally.failed > 0 || tally.passed == 0 ? 1 : 0;
}
