#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bowstring::study {

/// What is kept of a run beside its result document, and with it or without: everything that results.csv and the report
/// read. Numbers that are not known are empty.
struct RunRecord {
  using Number = std::optional<double>;

  std::string hash;
  std::string predecessor;  ///< the run whose result it started from; "" where it started from cold
  std::string status, reason;
  std::string second_order;  ///< "" where it was not judged
  std::vector<std::string> warnings;
  int unknowns = 0, iterations = 0, factorizations = 0, evaluations = 0, epochs = 0;
  std::map<std::string, Number> certificate;           ///< its numbers, by the document's keys
  std::vector<std::pair<std::string, Number>> energy;  ///< N mm, in the document's order, `total` last
  std::map<std::string, Number> values;                ///< by `value_key` of a quantity of interest
  double load_seconds = 0.0, setup_seconds = 0.0;
  std::vector<double> solve_seconds;  ///< one for each repeat
  double total_seconds = 0.0;
  double time_limit = 0.0;  ///< s, that ended the run; 0: none did
  std::string host;
  double peak_memory_MB = 0.0;  ///< of the process that solved it, and of what it solved before
  std::string document_sha256;  ///< of the result document (not compressed); "" where it is not kept
};

/// The record as the text of its file, `bowstring.run/1`. Its last key is the sha256 of all that stands before it, so
/// that any damage shows.
std::string run_text(const RunRecord& record);

/// Reads it back. Returns "", or what is wrong with it, as the second half of a sentence: "its digest does not fit".
std::string read_run_text(const std::string& text, RunRecord& out);

}  // namespace bowstring::study
