#include "tests/compare/reading.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace bowstring::testing {

RecordedResult read_sound(const std::string& document) {
  std::vector<DocumentFlaw> flaws;
  RecordedResult out = read_result(document, "it", flaws);
  REQUIRE(flaws.empty());
  return out;
}

}  // namespace bowstring::testing
