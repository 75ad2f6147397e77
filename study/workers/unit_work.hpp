#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "core/interfaces/registry.hpp"
#include "study/store/claim.hpp"
#include "study/store/folder.hpp"
#include "study/workers/run_solver.hpp"

namespace bowstring::study {

/// Whether a stored record is what the plan's run would come to: with every quantity, as many repeats, the document
/// where it is kept, ended by no shorter time limit, and begun where its predecessor ended if that converged.
bool is_complete(const Plan& plan, const Folder& folder, int run, const RunRecord& record, bool keep_documents);

/// Solves what of a unit is not there yet, and stores it.
class UnitWork {
 public:
  struct Hooks {
    std::function<bool()> go_on;      ///< false: stop as soon as possible
    std::function<void(int)> begins;  ///< a run, by its number
    std::function<void(const RunRecord&)> stored;
  };
  enum class Outcome : int { done, busy, stopped, failed };

  UnitWork(const Plan& plan, const Folder& folder, bool keep_documents, Registry& registry, Claims& claims, Hooks hooks)
      : plan_(plan),
        folder_(folder),
        keep_documents_(keep_documents),
        registry_(registry),
        claims_(claims),
        hooks_(std::move(hooks)) {}

  /// `wait`: for a run that another process has; else `busy`. `failed`: `problem` says what cannot be read or written.
  Outcome carry_out(const Unit& unit, bool wait, std::string& problem);

 private:
  bool take_claim(const std::string& hash, bool wait);
  Outcome take_step(const Unit& unit, std::size_t place, std::optional<CarriedState>& carried, std::string& problem);
  SolvedRun solve_guarded(int run, const CarriedState* carried, bool with_document);
  Outcome solve_and_store(int run, bool in_chain, std::optional<CarriedState>& carried, std::string& problem);
  bool load_predecessor(int run, std::optional<CarriedState>& carried, std::string& problem) const;

  const Plan& plan_;
  const Folder& folder_;
  const bool keep_documents_;
  Registry& registry_;
  Claims& claims_;
  const Hooks hooks_;
  int carried_from_ = -1;  ///< the run that `carried` is the result of
};

}  // namespace bowstring::study
