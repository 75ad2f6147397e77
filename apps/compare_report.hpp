#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/compare/result_differences.hpp"

namespace bowstring::apps {

/// One of the two things that are compared.
struct ComparedSide {
  std::string file;
  bool is_result = false;
  RecordedResult result;  ///< of a composition only `composition` is filled in
};

/// What `bowstring compare` says, before it is printed.
struct CompareReport {
  ComparedSide a, b;
  Comparison questions;
  std::optional<ResultDifferences> results;  ///< where both are results
  std::string warning;                       ///< ""

  bool anything_differs() const { return !questions.none() || (results && !results->bits.same()); }
};

/// As a table for people, on stdout, at most some 100 columns wide.
void print_table(const CompareReport& report);

/// One JSON document, `bowstring.compare/1`.
std::string json_text(const CompareReport& report);

}  // namespace bowstring::apps
