#include <doctest/doctest.h>

#include "tests/writers/small_result.hpp"

namespace bowstring::testing {

namespace {

std::string refusal(const std::string& document) {
  std::string text;
  for (const char* writer : {"csv", "svg", "vtp"}) {
    const Written result = written(writer, document);
    CHECK_FALSE(result.good);
    if (!text.empty()) CHECK(result.text == text);
    text = result.text;
  }
  return text;
}

}  // namespace

TEST_CASE("writers name what a document lacks, and where") {
  const std::string mend = "; give the document as `bowstring` prints it with --json";
  const std::string good = small_result(2);
  CHECK(refusal("{\"format\":\n  oops}") ==
        "line 2, column 3: found text that is not JSON, expected a "
        "\"bowstring.result/1\" document" +
            mend);
  CHECK(refusal("[]") == "format: found null, expected \"bowstring.result/1\"" + mend);
  CHECK(refusal(edited_result(good, "bowstring.result/1", "bowstring.result/9")) ==
        "format: found \"bowstring.result/9\", expected \"bowstring.result/1\"" + mend);
  CHECK(refusal("{\"format\": \"bowstring.result/1\", \"curves\": []}") ==
        "curves: found none, expected at least one curve" + mend);
  CHECK(refusal(edited_result(good, "\"kind\": \"vessel\"", "\"kind\": \"nerve\"")) ==
        "curves[0].kind: found \"nerve\", expected \"wire\" or \"vessel\"" + mend);
  CHECK(refusal(edited_result(good, "[6, 5, 6]", "[6, 5]")) ==
        "curves[0].radius_mm: found 2 entries, expected 3, one per node" + mend);
  CHECK(refusal(edited_result(good, "[50, 2]", "[50, 2, 1]")) ==
        "curves[0].points[1]: found 3 numbers, expected 2 numbers" + mend);
  CHECK(refusal(edited_result(good, "\"s_mm\": 70,", "\"s_mm\": \"far\",")) ==
        "contacts[1].s_mm: found \"far\", expected a number or null" + mend);
  CHECK(refusal(edited_result(good, "[[1, 0, 0, 0], [1, 0, 0, 0],", "[[1, 0, 0, 0], [1, 0, 0],")) ==
        "curves[0].frames[1]: found 3 numbers, expected 4 numbers" + mend);
  CHECK(refusal(edited_result(small_result(3), "[4, 5, 6]", "5")) ==
        "curves[0].moment_N_mm[1]: found number, expected 3 numbers" + mend);
  CHECK(refusal(edited_result(good, "[0.6, -0.8]", "[1, 0, 0]")) ==
        "contacts[1].direction: found 3 numbers, expected 2 numbers" + mend);
  CHECK(refusal(
            edited_result(good, "{\"on\": \"iliac\", \"end\": \"last\"}", "{\"on\": \"aorta\", \"end\": \"last\"}")) ==
        "supports[1].on: found \"aorta\", expected the name of a curve of this document" + mend);
}

}  // namespace bowstring::testing
