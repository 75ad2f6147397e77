#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"
#include "study/plan/plan.hpp"
#include "study/store/folder.hpp"

namespace bowstring::study {

struct PoolOptions {
  int jobs = 1;
  bool keep_documents = true;
  int shard = 1, shards = 1;  ///< of the plan's units, those whose number fits
};

/// How far it is, for people.
struct PoolProgress {
  int runs = 0, done = 0;  ///< of this command
  int converged = 0;       ///< of those that this command has solved
  int solved = 0;
  double seconds = 0.0;
};

struct PoolOutcome {
  int runs = 0;                       ///< of this shard
  int found = 0, solved = 0;          ///< there already; solved by this command
  bool stopped = false;               ///< by `stop`
  std::vector<std::string> problems;  ///< what could not be read or written, each once; then runs may be missing
};

/// Solves what of the plan is not stored yet, in `jobs` processes that take units from one list, each as it gets ready.
/// They are forked off this process, which must have no other threads, and share what it has loaded; they end when it
/// ends. A run whose process does not survive it is tried once more by a fresh one, and is then a result `failed` with
/// what became of the process. `stop` is looked at all the time: runs in flight are given up.
PoolOutcome run_pool(const Plan& plan, const Folder& folder, Registry& registry, const PoolOptions& options,
                     const std::atomic<bool>& stop, const std::function<void(const PoolProgress&)>& progress);

}  // namespace bowstring::study
