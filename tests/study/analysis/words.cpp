#include "study/analysis/words.hpp"

#include <doctest/doctest.h>

#include "core/composition/nearest.hpp"

namespace {

using namespace bowstring::study;
using bowstring::counted;

TEST_CASE("numbers as people read them") {
  CHECK(figure(9.7501) == "9.75");
  CHECK(figure(1234.4) == "1234");
  CHECK(figure(999.7) == "1000");
  CHECK(figure(-0.00312) == "-0.00312");
  CHECK(percent(0.0031) == "0.31 %");
  CHECK(percent(0.124) == "12 %");
  CHECK(percent(1.0) == "100 %");
  CHECK(percent(-2.5) == "-250 %");
  CHECK(seconds_text(0.0312) == "31 ms");
  CHECK(seconds_text(0.0997) == "0.1 s");
  CHECK(seconds_text(2.44) == "2.4 s");
  CHECK(seconds_text(310.2) == "310 s");
  CHECK(percent_range(0.1, 0.14) == "10…14 %");
  CHECK(percent_range(0.101, 0.102) == "10 %");
  CHECK(range_text("2.0", "2.0") == "2.0");
  CHECK(range_text("1.9", "2.1") == "1.9…2.1");
  CHECK(alternatives_text({"a", "b", "c"}) == "a, b or c");
  CHECK(counted(1, "line") == "1 line");
  CHECK(counted(2, "line") == "2 lines");
}

TEST_CASE("a clause that would be too long stays out") {
  std::string text = "1…2";
  CHECK(characters(text) == 3);
  CHECK(add_clause(text, "ab", 5));
  CHECK_FALSE(add_clause(text, "c", 5));
  CHECK(text == "1…2ab");
}

}  // namespace
