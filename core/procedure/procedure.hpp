#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/procedure/state_result.hpp"

namespace bowstring {

/// All that a composition asks to be solved: one state, or one for each [[step]]; each from its start, by
/// [continuation], from several starts.
class Procedure {
 public:
  /// Loads, checks and builds: every step, and the ends of what is walked. On refusal null.
  /// `carried`: a state in memory that the first state starts from, as in `prepare` of a session.
  static std::unique_ptr<Procedure> prepare(const CompositionRequest& request, Registry& registry, Refusal& refusal,
                                            const CarriedState* carried = nullptr);

  /// Each state begins where the one before it ended; one that does not converge is the last. `progress` as in `solve`
  /// of a session. Can be called once.
  std::vector<StateResult> run(const std::function<bool(const IterationRecord&)>& progress);

  /// Of the first state.
  const Session& session() const noexcept { return *session_; }
  /// All that its compositions read; absolute.
  const std::vector<std::string>& input_files() const noexcept { return input_files_; }

 private:
  Procedure(CompositionRequest request, Registry& registry) : request_(std::move(request)), registry_(registry) {}

  bool check_walk(const Session& session, const CompositionRequest& request, Refusal& refusal) const;
  StateResult solve_state(const CompositionRequest& request, std::unique_ptr<Session> session,
                          const CarriedState* carried,
                          const std::function<bool(const IterationRecord&)>& progress) const;

  CompositionRequest request_;
  Registry& registry_;
  std::optional<CarriedState> carried_;
  std::unique_ptr<Session> session_;
  std::vector<std::string> input_files_;
};

}  // namespace bowstring
