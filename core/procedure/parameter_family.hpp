#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/session/session.hpp"

namespace bowstring {

/// A composition as a function of one of its values: at t = 0 with the one end of a range, at t = 1 with the other.
/// Where the value changes numbers alone the session is changed in place, else it is built anew.
class ParameterFamily {
 public:
  using Build = std::function<std::unique_ptr<Session>(const CompositionRequest&, Refusal&)>;

  /// `session`: the composition as it stands, at any value.
  ParameterFamily(CompositionRequest request, const ContinuationTable& table, Build build,
                  std::unique_ptr<Session> session);

  /// A family of one member, which stays the caller's.
  explicit ParameterFamily(Session& only) : only_(&only) {}

  /// The session at t; null where the composition refuses that value. It stays the same object as long as `built` does
  /// not change.
  Session* at(double t, Refusal& refusal);
  Session& session() noexcept { return only_ != nullptr ? *only_ : *session_; }
  double share() const noexcept { return share_; }
  /// How often a session was built.
  int built() const noexcept { return built_; }
  const ValueRange& range() const noexcept { return range_; }
  std::unique_ptr<Session> release() noexcept { return std::move(session_); }

 private:
  CompositionRequest request_;
  std::string path_, from_position_, to_position_;
  ValueRange range_;
  Build build_;
  std::unique_ptr<Session> session_;
  Session* only_ = nullptr;
  std::string text_;     // of the value that the session has; "" as the composition has it
  double share_ = -1.0;  // of the session
  int built_ = 0;
};

}  // namespace bowstring
