#include "core/transport/check_answer.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace bowstring;

namespace {

TransportAnswer good() {
  TransportAnswer out;
  out.value = out.transport_cost = 1.0;
  out.plan = {{0, 1}, {2, 0}, {0.5, 0.5}};
  out.dual_a = {0, 0};
  out.dual_b = {0, 0, 0};
  return out;
}

template <class Change>
std::string flaw(const Change& change) {
  TransportAnswer answer = good();
  change(answer);
  return flaw_of(answer, 2, 3);
}

}  // namespace

TEST_CASE("answers of a method that cannot be taken") {
  CHECK(flaw([](TransportAnswer&) {}) == "");
  CHECK(flaw([](TransportAnswer& a) { a.value = NAN; }) == "its value is no finite number");
  CHECK(flaw([](TransportAnswer& a) { a.transport_cost = HUGE_VAL; }) == "the cost of its plan is no finite number");
  CHECK(flaw([](TransportAnswer& a) { a.plan.value[1] = NAN; }) == "its plan has an entry that is no finite number");
  CHECK(flaw([](TransportAnswer& a) { a.plan.column[1] = 3; }) == "its plan has an entry outside of the matrix");
  CHECK(flaw([](TransportAnswer& a) { a.plan.row[0] = -1; }) == "its plan has an entry outside of the matrix");
  CHECK(flaw([](TransportAnswer& a) { a.plan.row.pop_back(); }) == "its plan has lists of different lengths");
  CHECK(flaw([](TransportAnswer& a) {
          a.by_cost = {{2}, {0}, {1.0}};
        }) == "its derivative by costs has an entry outside of the matrix");
  CHECK(flaw([](TransportAnswer& a) { a.dual_b.pop_back(); }) == "its second dual has 2 numbers instead of 3");
  CHECK(flaw([](TransportAnswer& a) { a.position_gradient_a = {1.0}; }) ==
        "its derivative by the first positions has 1 numbers instead of 6");
}
