#include <doctest/doctest.h>

#include <cmath>

#include "study/store/run_record.hpp"

namespace bowstring::study {
namespace {

RunRecord sample_record() {
  RunRecord record;
  record.hash = std::string(64, 'a');
  record.predecessor = std::string(64, 'b');
  record.status = "converged";
  record.reason = "all \"thresholds\" hold, κ ≤ 1";
  record.second_order = "minimum";
  record.warnings = {"first", "second\nline"};
  record.unknowns = 550;
  record.iterations = 14;
  record.factorizations = 15;
  record.evaluations = 16;
  record.epochs = 2;
  record.certificate = {{"stationarity", 1.0 / 3.0}, {"min_stretch", std::nullopt}};
  record.energy = {{"wire-bending", 0.1}, {"anchoring", std::nullopt}, {"total", 1e-300}};
  record.values = {{"quantities.peak_displacement_mm", 9.4765}, {"max contacts.force_N", std::nullopt}};
  record.load_seconds = 0.001;
  record.setup_seconds = 0.002;
  record.solve_seconds = {0.01, 0.02};
  record.total_seconds = 0.05;
  record.host = "somewhere";
  record.peak_memory_MB = 33.25;
  record.document_sha256 = std::string(64, 'c');
  return record;
}

}  // namespace

TEST_CASE("a record gives back what it was made of, to the bit") {
  const RunRecord record = sample_record();
  RunRecord again;
  REQUIRE(read_run_text(run_text(record), again) == "");
  CHECK(run_text(again) == run_text(record));
  CHECK(*again.certificate.at("stationarity") == 1.0 / 3.0);
  CHECK(!again.certificate.at("min_stretch"));
  CHECK(again.energy.back().first == "total");
  CHECK(*again.energy.back().second == 1e-300);
  CHECK(again.solve_seconds == record.solve_seconds);
  CHECK(again.warnings == record.warnings);
}

TEST_CASE("any damage shows: every byte changed, every end cut off, anything added") {
  const std::string text = run_text(sample_record());
  REQUIRE(text.size() > 500);
  RunRecord ignored;
  int told = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string damaged = text;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    told += read_run_text(damaged, ignored).empty() ? 0 : 1;
    told += read_run_text(text.substr(0, at), ignored).empty() ? 0 : 1;
  }
  CHECK(told == 2 * static_cast<int>(text.size()));
  CHECK(read_run_text(text + " ", ignored) == "its digest does not fit");
  CHECK(read_run_text("", ignored) == "it ends before its digest");
}

}  // namespace bowstring::study
