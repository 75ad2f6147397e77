#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/compare_report.hpp"
#include "apps/number_table.hpp"
#include "apps/shell.hpp"

namespace bowstring::apps {

namespace {

constexpr int path_width = 42, value_width = 26;

/// Letters of a text, each with the bytes that it is made of.
std::vector<std::string> letters_of(const std::string& text) {
  std::vector<std::string> out;
  for (const char c : text) {
    if (out.empty() || width({c}) == 1) out.emplace_back();
    out.back() += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string cut(const std::vector<std::string>& letters, std::size_t begin) {
  const auto room = static_cast<std::size_t>(value_width);
  std::string out;
  std::size_t used = 0;
  if (begin > 0) out += "…", ++used;
  for (std::size_t i = begin; i < letters.size(); ++i) {
    const bool last = used + 1 == room && i + 1 < letters.size();
    out += last ? "…" : letters[i];
    ++used;
    if (used == room) break;
  }
  return out;
}

/// Two values so that the place where they begin to differ is seen.
std::pair<std::string, std::string> excerpts(const std::string& a, const std::string& b) {
  const std::vector<std::string> one = letters_of(a), other = letters_of(b);
  const auto room = static_cast<std::size_t>(value_width);
  if (one.size() <= room && other.size() <= room) return {cut(one, 0), cut(other, 0)};
  const auto same = std::mismatch(one.begin(), one.end(), other.begin(), other.end());
  const auto place = static_cast<std::size_t>(same.first - one.begin());
  constexpr std::size_t before = 8;
  const std::size_t begin = place + 2 < room ? 0 : place - before;
  return {cut(one, std::min(begin, one.size())), cut(other, std::min(begin, other.size()))};
}

void print_composition(const CompareReport& report) {
  const auto& differences = report.questions.composition;
  if (differences.empty()) {
    std::printf("composition: the same\n");
    return;
  }
  int column = width("composition") - 2;
  for (const CompositionDifference& one : differences) column = std::max(column, width(one.path) + 2);
  column = std::min(column, path_width);
  print_row(stdout, padded("composition", column + 4) + padded("A", value_width + 2) + "B");
  for (const CompositionDifference& one : differences) {
    const std::string indent = one.because_of.empty() ? "  " : "    ";
    const auto [a, b] = excerpts(one.a.value_or("(none)"), one.b.value_or("(none)"));
    std::string name = indent + one.path;
    if (width(name) > column + 2) {
      print_row(stdout, name);
      name.clear();
    }
    print_row(stdout, padded(name, column + 4) + padded(a, value_width + 2) + b);
  }
}

void print_provenance(const CompareReport& report) {
  if (!report.a.is_result || !report.b.is_result) return;
  if (report.questions.provenance.empty()) {
    std::printf("programs: the same\n");
    return;
  }
  std::printf("programs\n");
  for (const std::string& difference : report.questions.provenance) std::printf("  %s\n", difference.c_str());
}

void print_numbers(const std::string& heading, const std::vector<NumberDifference>& numbers) {
  print_number_table(stdout, heading, {"A", "B", "B − A"}, numbers);
}

void print_curves(const std::vector<CurveDifference>& curves) {
  if (curves.empty()) return;
  print_row(stdout, padded("distance between the curves", name_width) + padded_left("nodes", number_width) +
                        padded_left("mean", number_width) + padded_left("largest", difference_width) +
                        padded_left("at share", relative_width));
  for (const CurveDifference& one : curves) {
    const std::string name = padded("  " + one.name, name_width);
    if (!one.unknown.empty()) {
      print_row(stdout, name + "  " + one.unknown);
      continue;
    }
    std::string nodes = std::to_string(one.nodes_a);
    if (one.nodes_a != one.nodes_b) nodes += " and " + std::to_string(one.nodes_b);
    const bool same = one.largest == 0.0;
    print_row(stdout, name + padded_left(nodes, number_width) +
                          padded_left(same ? "same" : number(one.mean, 3) + " mm", number_width) +
                          padded_left(same ? "" : number(one.largest, 3) + " mm", difference_width) +
                          padded_left(same ? "" : number(one.largest_share, 2), relative_width));
  }
}

void print_seconds(const std::vector<NumberDifference>& seconds) {
  for (const NumberDifference& one : seconds) {
    const std::string ratio = one.a > 0.0 && std::isfinite(one.b) ? "× " + number(one.b / one.a, 3) : "";
    print_row(stdout,
              padded("  " + one.path + ", ms", name_width) + padded_left(known_number(1e3 * one.a, 3), number_width) +
                  padded_left(known_number(1e3 * one.b, 3), number_width) + padded_left(ratio, difference_width));
  }
}

void print_results(const ResultDifferences& found) {
  if (found.second_order.a != found.second_order.b) {
    const auto judged = [](const std::string& word) { return word.empty() ? std::string("not judged") : word; };
    std::printf("second order: %s in A, %s in B\n", judged(found.second_order.a).c_str(),
                judged(found.second_order.b).c_str());
  }
  if (found.bits.same()) std::printf("the same bits: %ld numbers\n", found.bits.numbers);
  print_numbers("quantities", found.quantities);
  print_numbers("energy, N mm", found.energies);
  print_numbers("losses", found.losses);
  print_numbers("certificate", found.certificate);
  print_curves(found.curves);
  print_numbers("forces, N", found.forces);
  print_numbers("effort", found.effort);
  print_seconds(found.seconds);
}

void print_side(const char* letter, const ComparedSide& side, bool both_results) {
  std::string what = side.is_result ? "result, " + side.result.status : "composition";
  if (side.is_result && !both_results) what += ": its composition is compared";
  std::printf("%s  %s (%s)\n", letter, side.file.c_str(), what.c_str());
}

}  // namespace

void print_table(const CompareReport& report) {
  print_side("A", report.a, report.results.has_value());
  print_side("B", report.b, report.results.has_value());
  if (report.results) print_results(*report.results);
  print_composition(report);
  print_provenance(report);
}

}  // namespace bowstring::apps
