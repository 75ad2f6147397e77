#include "plugins/sdk/guard.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

namespace bowstring {

TEST_CASE("guard answers what its body answers") {
  CHECK(guard([] {}).ok());
  CHECK(guard([] { return Status{}; }).ok());
  const Status status = guard([] { return Status::failure(Code::refused, "too far"); });
  CHECK(status.code == Code::refused);
  CHECK(status.text == "too far");
}

TEST_CASE("guard turns exceptions into statuses") {
  const Status own = guard([] { throw StatusError(Code::unsupported, "no torsion"); });
  CHECK(own.code == Code::unsupported);
  CHECK(own.text == "no torsion");
  const Status standard = guard([]() -> Status { throw std::out_of_range("parameter 'x'"); });
  CHECK(standard.code == Code::failed);
  CHECK(standard.text == "parameter 'x'");
  CHECK(guard([] { throw 1; }).text == "an exception that is no std::exception was thrown");
}

}  // namespace bowstring
