#include "core/procedure/parameter_family.hpp"

#include <utility>

#include "core/session/revalue.hpp"

namespace bowstring {

ParameterFamily::ParameterFamily(CompositionRequest request, const ContinuationTable& table, Build build,
                                 std::unique_ptr<Session> session)
    : request_(std::move(request)),
      path_(table.path),
      from_position_(table.from_position),
      to_position_(table.to_position),
      range_(table.range),
      build_(std::move(build)),
      session_(std::move(session)) {}

Session* ParameterFamily::at(double t, Refusal& refusal) {
  const std::string text = range_.text(t);
  if (text == text_) {
    share_ = t;
    return &session();
  }
  const Override change{path_, text, t < 0.5 ? from_position_ : to_position_, "", true};
  if (!revalue(*session_, change)) {
    CompositionRequest request = request_;
    request.overrides.push_back(change);
    std::unique_ptr<Session> session = build_(request, refusal);
    if (session == nullptr) return nullptr;
    session_ = std::move(session);
    ++built_;
  }
  text_ = text;
  share_ = t;
  return session_.get();
}

}  // namespace bowstring
