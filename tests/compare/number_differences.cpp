#include "core/compare/number_differences.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace bowstring {

namespace {

const char* const document = R"({"status": "converged", "reason": "all", "composition": {"schema": 1},
  "solver": {"iterations": 12, "seconds": {"solve": 0.1}, "history": [{"energy": 3.5}, {"energy": 3.25}]},
  "certificate": {"stationarity": 1e-12}, "curves": [{"name": "v", "points": [[0.0, 0.5], [1.0, 2.0]]}],
  "contacts": [], "states": [{"name": "in", "quantities": {"peak_displacement_mm": null}}]})";

std::string edited(const std::string& word, const std::string& by) {
  std::string out = document;
  REQUIRE(out.find(word) != std::string::npos);
  return out.replace(out.find(word), word.size(), by);
}

}  // namespace

TEST_CASE("a document has its own bits, and another time changes nothing") {
  const BitComparison same = compare_bits(document, edited("0.1", "0.2"));
  CHECK(same.same());
  CHECK(same.numbers == 8);
  CHECK(compare_bits(document, edited("\"all\"", "\"every one\"")).same());
}

TEST_CASE("one bit, wherever it is") {
  const double next = std::nextafter(3.25, 4.0);
  const BitComparison history = compare_bits(document, edited("3.25", "3.2500000000000004"));
  REQUIRE(history.different.size() == 1);
  CHECK(history.different[0].path == "solver.history.1.energy");
  CHECK(history.different[0].b == next);
  CHECK(history.different[0].absolute() == next - 3.25);
  CHECK(history.different[0].relative() == (next - 3.25) / 3.25);
  const BitComparison point = compare_bits(document, edited("0.0", "-0.0"));
  REQUIRE(point.different.size() == 1);
  CHECK(point.different[0].path == "curves.v.points.0.0");
  CHECK(std::isnan(point.different[0].relative()));
}

TEST_CASE("what is unknown on one side, of another kind, or missing") {
  const BitComparison unknown = compare_bits(document, edited("null", "2.0"));
  REQUIRE(unknown.different.size() == 1);
  CHECK(unknown.different[0].path == "states.in.quantities.peak_displacement_mm");
  CHECK(std::isnan(unknown.different[0].a));
  const auto otherwise = [](const std::string& other) { return compare_bits(document, other).otherwise; };
  using Lines = std::vector<std::string>;
  CHECK(otherwise(edited("\"converged\"", "\"stalled\"")) == Lines{"'status' is \"converged\" and \"stalled\""});
  CHECK(otherwise(edited("\"contacts\": []", "\"contacts\": [1.0]")) == Lines{"'contacts' has 0 and 1 entries"});
  CHECK(otherwise(edited("\"iterations\": 12, ", "")) == Lines{"'solver.iterations' is in the first alone"});
  CHECK(otherwise(edited("\"iterations\": 12", "\"iterations\": 12, \"epochs\": 1")) ==
        Lines{"'solver.epochs' is in the second alone"});
}

TEST_CASE("the largest differences: each kind once, residuals last") {
  std::string other = edited("1e-12", "5e-10");
  for (const auto& [word, by] : {std::pair<const char*, const char*>{"0.5", "0.5000001"}, {"2.0", "2.2"}}) {
    other.replace(other.find(word), 3, by);
  }
  const BitComparison bits = compare_bits(document, other);
  REQUIRE(bits.different.size() == 3);
  const std::vector<NumberDifference> largest = largest_differences(bits, 5);
  REQUIRE(largest.size() == 2);
  CHECK(largest[0].path == "curves.v.points.1.1");
  CHECK(largest[1].path == "certificate.stationarity");
  CHECK(largest_differences(bits, 1).size() == 1);
}

}  // namespace bowstring
