#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "apps/compare_report.hpp"
#include "apps/given_file.hpp"
#include "apps/shell.hpp"
#include "core/compare/rerun.hpp"
#include "core/composition/toml_text.hpp"

namespace bowstring::apps {

namespace {

/// JSON is a table; no TOML text begins with a brace.
bool begins_as_json(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n", text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0);
  return first != std::string::npos && text[first] == '{';
}

/// Says what a text is that is neither of the two forms; false where it may be a composition.
bool is_neither_form(const std::string& file, const std::string& text) {
  Report problems;
  const auto source = std::make_shared<Source>(Source{file, {}, 0});
  if (read_toml(text, source, problems)) return false;
  Refusal refusal;
  refusal.errors = problems.sorted();
  for (InputError& error : refusal.errors) {
    error.expected = "a composition (TOML) or a result document (JSON, also in gzip)";
  }
  report(refusal);
  return true;
}

/// Resolves a composition with every step; returns an exit code.
int resolve(const CompositionRequest& request, Registry& registry, std::string& resolved) {
  std::size_t steps = 1;
  for (std::size_t k = 0; k < steps; ++k) {
    CompositionRequest step = request;
    step.step = static_cast<int>(k);
    step.from_memory = k > 0;
    CompositionOutcome outcome = load_composition(step, registry);
    if (!outcome.composition) return report({std::move(outcome.errors), std::move(outcome.plugin_failure)});
    if (k > 0) continue;
    resolved = std::move(outcome.composition->resolved_json);
    steps = std::max<std::size_t>(1, outcome.composition->steps.size());
  }
  return exit_converged;
}

/// Reads one side; `host` becomes the one that knows its plugins. Returns an exit code.
int read_side(const CommonOptions& common, ComparedSide& side, std::unique_ptr<PluginHost>& host) {
  std::string text;
  if (!read_given_file(side.file, text)) return exit_wrong_input;
  side.is_result = begins_as_json(text);
  if (side.is_result) {
    if (!read_given_result(side.file, std::move(text), side.result)) return exit_wrong_input;
    host = std::make_unique<PluginHost>(host_options(common, request_of(side.result, side.file)));
    return exit_converged;
  }
  if (is_neither_form(side.file, text)) return exit_wrong_input;
  CompositionRequest request;
  request.file = side.file;
  request.text = std::move(text);
  host = std::make_unique<PluginHost>(host_options(common, request));
  return resolve(request, *host, side.result.composition);
}

std::string warning_of(const CompareReport& report) {
  const int things = report.questions.things();
  if (things < 2) return "";
  return std::to_string(things) + " things differ: " +
         (report.results ? "what follows cannot be laid to one of them"
                         : "what their results differ in cannot be laid to one of them");
}

}  // namespace

int compare(const CommonOptions& common, const CompareOptions& options) {
  CompareReport report;
  report.a.file = options.a;
  report.b.file = options.b;
  std::unique_ptr<PluginHost> of_a, of_b;
  const int a = read_side(common, report.a, of_a), b = read_side(common, report.b, of_b);
  if (a != exit_converged || b != exit_converged) return a != exit_converged ? a : b;

  if (report.a.is_result && report.b.is_result) {
    report.questions = compare_questions(report.a.result, report.b.result, of_a.get());
    report.results = result_differences(report.a.result, report.b.result);
  } else {
    report.questions.composition =
        composition_differences(report.a.result.composition, report.b.result.composition, of_a.get());
  }
  report.warning = warning_of(report);
  if (!report.warning.empty()) std::fprintf(stderr, "warning: %s\n", report.warning.c_str());
  if (options.json) {
    std::printf("%s\n", json_text(report).c_str());
  } else {
    print_table(report);
  }
  return flushed(report.anything_differs() ? exit_fell_short : exit_converged);
}

}  // namespace bowstring::apps
