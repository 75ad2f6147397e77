#include <csignal>

#include <CLI/CLI.hpp>

#include "apps/commands.hpp"
#include "core/result/provenance.hpp"

int main(int argc, char** argv) {
  using namespace bowstring::apps;
  std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves is an error of writing, not the end
  CLI::App app{"Bowstring: elastic wires in elastic vessels, coupled by unilateral contact"};
  app.set_version_flag("--version", std::string("bowstring ") + bowstring::bowstring_version);
  app.require_subcommand(1);
  CommonOptions common;
  const auto plugin_path = [&](CLI::App* command) {
    command
        ->add_option("--plugin-path", common.plugin_path, "folder with plugins, searched before all others; repeatable")
        ->allow_extra_args(false);
  };
  const auto overrides = [](CLI::App* command, std::vector<std::string>& set) {
    command->add_option("--set", set, "path=value: overrides one value of the composition; repeatable")
        ->allow_extra_args(false);
  };

  SolveOptions solve_options;
  CLI::App* solve_command = app.add_subcommand("solve", "solve a composition and certify the result");
  solve_command->add_option("FILE", solve_options.file, "composition (TOML)")->required();
  overrides(solve_command, solve_options.set);
  solve_command->add_option("--out", solve_options.out, "write the result document (JSON) to this file");
  solve_command
      ->add_option("--write", solve_options.write, "writer=file: also write the result in this format; repeatable")
      ->allow_extra_args(false);
  solve_command->add_flag("--json", solve_options.json, "print the result document, and nothing else, on stdout");
  plugin_path(solve_command);

  std::string explain_file;
  std::vector<std::string> explain_set;
  CLI::App* explain_command = app.add_subcommand("explain", "say what would be built and why; solve nothing");
  explain_command->add_option("FILE", explain_file, "composition (TOML)")->required();
  overrides(explain_command, explain_set);
  plugin_path(explain_command);

  CheckCommandOptions check_options;
  CLI::App* check_command = app.add_subcommand(
      "check", "judge derivatives, invariances, scaling and rigid modes of a composition, term by term");
  check_command->add_option("FILE", check_options.file, "composition (TOML)")->required();
  overrides(check_command, check_options.set);
  check_command->add_flag("--json", check_options.json, "print the report as JSON, and nothing else, on stdout");
  plugin_path(check_command);

  StudyOptions study_options;
  CLI::App* study_command = app.add_subcommand("study", "run a study; stops and resumes at any point");
  study_command->add_option("FILE", study_options.file, "study (TOML)")->required();
  study_command->add_option("--out", study_options.out, "the study's folder: results.csv, report.html, runs/")
      ->required();
  study_command->add_option("--jobs", study_options.jobs, "processes that solve (default: one for each core)")
      ->check(CLI::Range(1, 1024));
  study_command->add_option("--shard", study_options.shard, "i/n: solve the i-th of n parts of the runs");
  study_command->add_option("--keep", study_options.keep, "full: result documents, compressed; summary: figures alone")
      ->check(CLI::IsMember({"full", "summary"}));
  study_command->add_flag("--reduced", study_options.reduced, "the smaller study that the file's [reduced] says");
  study_command->add_flag("--check", study_options.check, "solve nothing: read all that is there and verify it");
  plugin_path(study_command);

  CompareOptions compare_options;
  CLI::App* compare_command =
      app.add_subcommand("compare", "say in what two compositions or results differ, and what that did");
  compare_command->add_option("A", compare_options.a, "composition (TOML) or result document (JSON, also in gzip)")
      ->required();
  compare_command->add_option("B", compare_options.b, "the same")->required();
  compare_command->add_flag("--json", compare_options.json,
                            "print the differences as JSON, and nothing else, on stdout");
  plugin_path(compare_command);

  RerunOptions rerun_options;
  CLI::App* rerun_command =
      app.add_subcommand("rerun", "solve again what a result document holds; say whether the same bits came out");
  rerun_command->add_option("RESULT", rerun_options.file, "result document (JSON, also in gzip)")->required();
  rerun_command->add_flag("--force", rerun_options.force,
                          "solve with what is here, though a plugin, the kernel or a start is not what it was");
  rerun_command->add_option("--out", rerun_options.out, "write the new result document (JSON) to this file");
  rerun_command->add_flag("--json", rerun_options.json, "print the new result document, and nothing else, on stdout");
  plugin_path(rerun_command);

  TransportOptions transport_options;
  CLI::App* transport_command = app.add_subcommand("transport", "optimal transport between two measures");
  transport_command
      ->add_option("A", transport_options.a,
                   "POINTS.csv, POINTS.csv#curve where its rows are a curve in order, or RESULT.json#CURVE")
      ->required();
  transport_command->add_option("B", transport_options.b, "the same")->required();
  transport_command->add_option("--method", transport_options.method, "transport plugin")->capture_default_str();
  transport_command->add_option("--cost", transport_options.cost, "ground-cost plugin")->capture_default_str();
  transport_command->add_option("--set", transport_options.set, "key=value of the method or the cost; repeatable")
      ->allow_extra_args(false);
  transport_command->add_option("--points", transport_options.points, "places at which curves are resampled")
      ->check(CLI::Range(1, 1000000));
  transport_command->add_option("--weights", transport_options.weights, "weights of the places of curves")
      ->check(CLI::IsMember({"uniform", "arc-length", "lumen-section"}));
  transport_command
      ->add_option("--repeat", transport_options.repeat, "so many comparisons more, after small steps of A's places")
      ->check(CLI::Range(1, 1000000));
  transport_command->add_option("--out", transport_options.out, "write the document (JSON) to this file");
  transport_command
      ->add_option("--write", transport_options.write, "writer=file: also write it in this format; repeatable")
      ->allow_extra_args(false);
  transport_command->add_flag("--json", transport_options.json, "print the document, and nothing else, on stdout");
  plugin_path(transport_command);

  std::string kind;
  bool plugins_json = false;
  CLI::App* plugins_command = app.add_subcommand("plugins", "list what is installed");
  plugins_command->add_option("KIND", kind, "only this kind");
  plugins_command->add_flag("--json", plugins_json, "as JSON");
  plugin_path(plugins_command);

  std::string what;
  bool describe_json = false;
  CLI::App* describe_command = app.add_subcommand("describe", "parameters of one plugin with unit, bounds and default");
  describe_command->add_option("KIND/NAME", what, "for instance energy/wire-bending")->required();
  describe_command->add_flag("--json", describe_json, "as JSON");
  plugin_path(describe_command);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_converged : exit_wrong_input;
  }
  if (solve_command->parsed()) return solve(common, solve_options);
  if (explain_command->parsed()) return explain(common, explain_file, explain_set);
  if (check_command->parsed()) return check(common, check_options);
  if (study_command->parsed()) return study(common, study_options);
  if (compare_command->parsed()) return compare(common, compare_options);
  if (rerun_command->parsed()) return rerun(common, rerun_options);
  if (transport_command->parsed()) return transport(common, transport_options);
  if (plugins_command->parsed()) return list_plugins(common, kind, plugins_json);
  return describe(common, what, describe_json);
}
