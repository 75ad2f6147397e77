// Recomputes the certificates of written result documents from the documents alone.

#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "tests/recheck/recheck.hpp"

namespace {

struct Tally {
  int hold = 0, fail = 0, without_claim = 0;
};

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : "; ") + part;
  return out;
}

void print_numbers(const std::string& file, const recheck::Findings& found) {
  const double informative = 1e-8 + found.rounding_floor;
  std::printf("%s: %s | stationarity %.2e N (1e-8 + floor: %s) | penetration %.2e mm | complementarity %.2e N mm | ",
              file.c_str(), found.status.c_str(), found.stationarity.value,
              found.stationarity.value <= informative ? "met" : "not met", found.rows.violation.value,
              found.rows.complementarity.value);
  if (std::isfinite(found.rows.smallest_multiplier)) {
    std::printf("smallest multiplier %.2e N | ", found.rows.smallest_multiplier);
  } else {
    std::printf("no inequality row | ");
  }
  if (std::isfinite(found.depth)) std::printf("deepest %.2e mm | ", found.depth);
  std::printf("energy difference %.2e N mm | ", found.energy_difference.value);
}

/// Prints one line; answers whether the claim of one state of a document stands.
bool judge_state(const std::string& label, const recheck::Result& result, bool allow_unknown, Tally& tally) {
  try {
    const recheck::Findings found = recheck::recheck(result);
    print_numbers(label, found);
    const std::string unknown = joined(found.not_rechecked);
    if (!unknown.empty()) std::printf("not rechecked: %s | ", unknown.c_str());
    if (!found.claims()) {
      std::printf("no claim%s\n", found.reasons.empty() && unknown.empty() ? ", though every threshold holds" : "");
      ++tally.without_claim;
      return true;
    }
    const bool holds = found.reasons.empty() && (unknown.empty() || allow_unknown);
    const char* verdict = unknown.empty() ? "holds" : "the rest holds";
    if (holds) {
      std::printf("%s\n", verdict);
    } else {
      std::printf("DOES NOT HOLD: %s\n", found.reasons.empty() ? "not rechecked" : joined(found.reasons).c_str());
    }
    ++(holds ? tally.hold : tally.fail);
    return holds;
  } catch (const std::exception& error) {
    std::printf("%s: DOES NOT HOLD: %s\n", label.c_str(), error.what());
    ++tally.fail;
    return false;
  }
}

/// Prints a line for each state; answers whether every claim of the document stands.
bool judge(const std::string& file, bool allow_unknown, Tally& tally) {
  bool all = true;
  try {
    for (const auto& [name, result] : recheck::read_results(file)) {
      all = judge_state(name.empty() ? file : file + ", " + name, result, allow_unknown, tally) && all;
    }
    return all;
  } catch (const std::exception& error) {
    std::printf("%s: DOES NOT HOLD: %s\n", file.c_str(), error.what());
    ++tally.fail;
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool allow_unknown = false;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--allow-unknown") == 0) {
      allow_unknown = true;
    } else {
      files.emplace_back(argv[i]);
    }
  }
  if (files.empty()) {
    std::fprintf(stderr, "usage: recheck [--allow-unknown] RESULT.json …\n");
    return 2;
  }
  Tally tally;
  bool all = true;
  for (const std::string& file : files) all = judge(file, allow_unknown, tally) && all;
  std::printf("%d hold, %d do not hold, %d without a claim\n", tally.hold, tally.fail, tally.without_claim);
  return all ? 0 : 1;
}
