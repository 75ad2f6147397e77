#pragma once

#include <exception>
#include <type_traits>
#include <utility>

#include "core/interfaces/status.hpp"

namespace bowstring {

/// Thrown inside a plugin to leave deep code with a status; `guard` hands that status on as it is.
class StatusError : public std::exception {
 public:
  explicit StatusError(Status status) noexcept : status_(std::move(status)) {}
  StatusError(Code code, std::string text) noexcept : status_{code, std::move(text)} {}

  const Status& status() const noexcept { return status_; }
  const char* what() const noexcept override { return status_.text.c_str(); }

 private:
  Status status_;
};

/// Runs `body`, which returns nothing or a Status, and answers in its place when it throws: the status of a
/// `StatusError`, or `failed` with the text of any other exception. No exception leaves a plugin.
template <class Body>
Status guard(Body&& body) noexcept {
  try {
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      return {};
    } else {
      return body();
    }
  } catch (const StatusError& error) {
    return error.status();
  } catch (const std::exception& error) {
    return Status::failure(Code::failed, error.what());
  } catch (...) {
    return Status::failure(Code::failed, "an exception that is no std::exception was thrown");
  }
}

}  // namespace bowstring
