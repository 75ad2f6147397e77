#include <cstdio>
#include <filesystem>

#include "apps/given_file.hpp"
#include "apps/number_table.hpp"
#include "apps/outputs.hpp"
#include "apps/shell.hpp"
#include "apps/watched_run.hpp"
#include "core/compare/number_differences.hpp"
#include "core/compare/rerun.hpp"
#include "core/composition/nearest.hpp"
#include "core/result/document.hpp"
#include "study/store/gzip.hpp"

namespace bowstring::apps {

namespace {

constexpr std::size_t most_differences = 8;

/// The document of the run that this one started from, which lies beside it.
std::optional<Predecessor> predecessor_of(const RecordedResult& result, const std::string& file) {
  if (result.predecessor.empty()) return std::nullopt;
  Predecessor out;
  out.file = (std::filesystem::path(file).parent_path() / (result.predecessor + ".result.json.gz")).string();
  out.problem = study::read_gzip(out.file, out.text);
  return out;
}

/// Why the same bits cannot be promised, and what can be done about it. Returns an exit code.
int refuse(const std::string& file, const Rerun& plan) {
  if (!plan.differences.empty()) {
    const auto count = static_cast<int>(plan.differences.size());
    complain(file + ": the same bits cannot be promised, because " + counted(count, "thing") +
             (count == 1 ? " is not what it was" : " are not what they were"));
    for (const std::string& difference : plan.differences) std::fprintf(stderr, "  %s\n", difference.c_str());
  }
  if (!plan.unusable.ok()) {
    complain(plan.unusable.text);
    std::fprintf(stderr, "--force would not help: nothing can be solved without this plugin\n");
    return exit_plugin_failed;
  }
  std::fprintf(stderr, "--force would solve with what is here, and report the largest differences\n");
  return exit_wrong_input;
}

void print_largest(std::FILE* to, const BitComparison& bits) {
  print_number_table(to, "largest differences", {"then", "here", "here − then"},
                     largest_differences(bits, most_differences));
  for (const std::string& other : bits.otherwise) std::fprintf(to, "  %s\n", other.c_str());
}

/// What came out, beside what is recorded.
void print_verdict(std::FILE* to, const std::string& file, const RecordedResult& recorded, const StateResult& here,
                   const BitComparison& bits) {
  const char* status = verdict_name(here.solution.certificate.verdict);
  std::fprintf(to, "%s: %s%s\n", file.c_str(), status,
               status == recorded.status ? ", as recorded" : (", recorded '" + recorded.status + "'").c_str());
  if (bits.same()) {
    std::fprintf(to, "the same bits: %ld numbers\n", bits.numbers);
  } else {
    std::fprintf(to, "other numbers: %zu of %ld\n", bits.different.size(), bits.numbers);
    print_largest(to, bits);
  }
}

void explain_other_numbers(std::FILE* to, const std::vector<std::string>& input_files) {
  if (input_files.empty()) {
    std::fprintf(to,
                 "the same programs, other numbers, and it reads no file: did a time limit or an interrupt end it?\n");
  } else {
    std::fprintf(to, "the same programs, other numbers: has a file that it reads changed? %s\n",
                 comma_separated(input_files).c_str());
  }
}

}  // namespace

int rerun(const CommonOptions& common, const RerunOptions& options) {
  std::string text;
  RecordedResult recorded;
  if (!read_given_file(options.file, text) || !read_given_result(options.file, std::move(text), recorded)) {
    return exit_wrong_input;
  }
  const std::string composition = options.file + "[composition]";
  PluginHost host(host_options(common, request_of(recorded, composition)));
  Outputs outputs;
  if (const int code = outputs.prepare(options.out, {}, host); code != exit_converged) return code;
  const Rerun plan = plan_rerun(recorded, composition, predecessor_of(recorded, options.file), host);
  if (!plan.unusable.ok() || (!plan.differences.empty() && !options.force)) return refuse(options.file, plan);
  for (const std::string& difference : plan.differences) std::fprintf(stderr, "warning: %s\n", difference.c_str());

  Refusal refusal;
  const CarriedState* carried = plan.carried ? &*plan.carried : nullptr;
  const std::unique_ptr<Procedure> procedure = Procedure::prepare(plan.request, host, refusal, carried);
  if (procedure == nullptr) return report(refusal);
  std::vector<std::string> read = procedure->input_files();
  read.push_back(options.file);
  if (const int code = outputs.spare(read); code != exit_converged) return code;
  const std::vector<StateResult> states = run_watched(*procedure);
  const StateResult& result = states.back();
  if (!result.readable.ok()) complain(result.readable.text);

  const std::string document = result_document(states);
  const int written = outputs.write(document);
  const BitComparison bits = compare_bits(recorded.text, document);
  std::FILE* said = options.json ? stderr : stdout;
  if (options.json) std::fwrite(document.data(), 1, document.size(), stdout);
  print_verdict(said, options.file, recorded, result, bits);
  if (!bits.same() && plan.differences.empty()) explain_other_numbers(said, procedure->input_files());
  for (const std::string& warning : result.solution.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (written != exit_converged) return written;
  return flushed(bits.same() ? exit_converged : exit_fell_short);
}

}  // namespace bowstring::apps
