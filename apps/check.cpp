#include "core/check/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "apps/shell.hpp"
#include "core/composition/nearest.hpp"

namespace bowstring::apps {

namespace {

using Json = nlohmann::json;

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void print_lines(const char* heading, const std::vector<CheckLine>& lines) {
  std::printf("%s\n", heading);
  int subject = 0, what = 0;
  bool measured = false;
  for (const CheckLine& line : lines) {
    subject = std::max(subject, width(line.subject));
    what = std::max(what, width(line.what));
    measured = measured || std::isfinite(line.error);
  }
  for (const CheckLine& line : lines) {
    std::string row = "  " + padded(check_verdict_name(line.verdict), 8) + padded(line.subject, subject + 2) +
                      padded(line.what, what + 2);
    if (measured) row += padded(std::isfinite(line.error) ? number(line.error, 2) : "", 10);
    row += line.text + (line.text.empty() || line.where.empty() ? "" : ": ") + line.where;
    row.erase(row.find_last_not_of(' ') + 1);
    std::printf("%s\n", row.c_str());
  }
}

void print_scales(const CheckReport& report) {
  std::printf("  %-40s %9s %12s   %s\n", "unknowns", "number", "gradient", "Hessian diagonal at the start");
  for (const FieldScale& field : report.fields) {
    if (field.unknowns == 0) continue;
    const std::string name = field.field + " of '" + field.curve + "'";
    std::printf("  %s %9d %9s %s   %s … %s %s\n", padded(name, 40).c_str(), field.unknowns,
                number(field.gradient, 2).c_str(), field.angle ? "Nmm" : "N  ",
                number(field.smallest_diagonal, 2).c_str(), number(field.largest_diagonal, 2).c_str(),
                field.angle ? "N mm" : "N/mm");
  }
  if (report.row_groups.empty()) return;
  std::printf("  %-40s %9s %12s   %s\n", "rows", "number", "at a bound", "largest violation at the start");
  for (const RowScale& rows : report.row_groups) {
    std::printf("  %s %9d %12d   %s mm\n", padded(rows.name, 40).c_str(), rows.rows, rows.active,
                number(rows.violation, 2).c_str());
  }
}

Json lines_json(const std::vector<CheckLine>& lines) {
  Json out = Json::array();
  for (const CheckLine& line : lines) {
    out.push_back({{"verdict", check_verdict_name(line.verdict)},
                   {"subject", line.subject},
                   {"what", line.what},
                   {"error", finite(line.error)},
                   {"where", line.where},
                   {"text", line.text}});
  }
  return out;
}

Json report_json(const CheckReport& report) {
  Json fields = Json::array(), rows = Json::array();
  for (const FieldScale& field : report.fields) {
    fields.push_back({{"curve", field.curve},
                      {"field", field.field},
                      {"unit", field.angle ? "rad" : "mm"},
                      {"unknowns", field.unknowns},
                      {"gradient", finite(field.gradient)},
                      {"smallest_diagonal", finite(field.smallest_diagonal)},
                      {"largest_diagonal", finite(field.largest_diagonal)}});
  }
  for (const RowScale& group : report.row_groups) {
    rows.push_back({{"name", group.name},
                    {"rows", group.rows},
                    {"vanishing", group.vanishing},
                    {"smallest_gradient", finite(group.smallest_gradient)},
                    {"largest_gradient", finite(group.largest_gradient)},
                    {"active", group.active},
                    {"violation_mm", finite(group.violation)}});
  }
  return {{"format", "bowstring.check/1"},
          {"verdict", check_verdict_name(report.verdict())},
          {"states", report.states},
          {"directions", report.directions},
          {"derivatives", lines_json(report.derivatives)},
          {"invariances", lines_json(report.invariances)},
          {"scaling", {{"lines", lines_json(report.scaling)}, {"fields", fields}, {"rows", rows}}},
          {"modes", lines_json(report.modes)}};
}

void print_report(const Session& session, const CheckReport& report) {
  if (!session.composition.title.empty()) std::printf("%s\n", session.composition.title.c_str());
  const std::string heading = "derivatives: largest relative error at " + counted(report.states, "state") + ", along " +
                              counted(report.directions, "direction") + " each";
  print_lines(heading.c_str(), report.derivatives);
  print_lines("invariances: relative change under a rigid motion of everything", report.invariances);
  print_lines("scaling", report.scaling);
  print_scales(report);
  print_lines("modes: what nothing holds at the start", report.modes);
  int failed = 0, notes = 0;
  for (const std::vector<CheckLine>* lines :
       {&report.derivatives, &report.invariances, &report.scaling, &report.modes}) {
    for (const CheckLine& line : *lines) {
      failed += line.verdict == CheckVerdict::failed;
      notes += line.verdict == CheckVerdict::note;
    }
  }
  const std::string remarks = notes > 0 ? ", " + counted(notes, "note") : "";
  std::printf("%s%s\n",
              failed > 0 ? ("FAILED: " + counted(failed, "check") + " fell short").c_str() : "all checks hold",
              remarks.c_str());
}

}  // namespace

int check(const CommonOptions& common, const CheckCommandOptions& options) {
  CompositionRequest request;
  request.file = options.file;
  if (!parse_overrides(options.set, request.overrides)) return exit_wrong_input;
  PluginHost host = make_host(common, options.file);
  Refusal refusal;
  const std::unique_ptr<Session> session = prepare(request, host, refusal);
  if (session == nullptr) return report(refusal);
  const CheckReport found = bowstring::check(*session->assembly);
  if (options.json) {
    std::printf("%s\n", report_json(found).dump(1).c_str());
  } else {
    print_report(*session, found);
  }
  const int code = flushed(found.verdict() == CheckVerdict::failed ? exit_fell_short : exit_converged);
  for (const std::string& warning : session->composition.warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  for (const std::string& warning : session->scene->warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  return code;
}

}  // namespace bowstring::apps
