#include "study/workers/pool.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <set>
#include <thread>
#include <utility>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "study/store/claim.hpp"
#include "study/workers/run_solver.hpp"
#include "study/workers/unit_work.hpp"

namespace bowstring::study {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto patience = std::chrono::seconds(2);  // with a run that is to be given up
constexpr auto look_every = std::chrono::milliseconds(5);
constexpr int most_attempts = 2;
constexpr int most_rounds = 3;
constexpr int most_idle_deaths = 5;

long long milliseconds_now() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now().time_since_epoch()).count();
}

/// What one worker tells the others, in memory that they share.
struct Desk {
  std::atomic<int> run;           ///< in flight; -1: none
  std::atomic<long long> since;   ///< when it began, ms
  std::atomic<bool> finished;     ///< it has found no more work
  std::atomic<bool> has_problem;  ///< `problem` is written
  char problem[2048];
};

struct Board {
  std::atomic<int> next;  ///< place in the list of units
  std::atomic<int> solved, converged;
  std::atomic<bool> stop;
};
static_assert(std::atomic<long long>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// Memory that this process shares with those that it forks.
class SharedBoard {
 public:
  explicit SharedBoard(int desks) : size_(sizeof(Board) + static_cast<std::size_t>(desks) * sizeof(Desk)) {
    memory_ = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
    board_ = new (memory_) Board();
    auto* first = reinterpret_cast<Desk*>(static_cast<char*>(memory_) + sizeof(Board));
    for (int i = 0; i < desks; ++i) desks_.push_back(new (first + i) Desk());
  }
  ~SharedBoard() { ::munmap(memory_, size_); }
  SharedBoard(const SharedBoard&) = delete;
  SharedBoard& operator=(const SharedBoard&) = delete;

  Board& board() noexcept { return *board_; }
  Desk& desk(std::size_t i) noexcept { return *desks_[i]; }

 private:
  std::size_t size_;
  void* memory_ = nullptr;
  Board* board_ = nullptr;
  std::vector<Desk*> desks_;
};

std::string end_of_process(int status) {
  if (WIFSIGNALED(status)) {
    return "signal " + std::to_string(WTERMSIG(status)) + " (" + ::strsignal(WTERMSIG(status)) + ")";
  }
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

class Pool {
 public:
  Pool(const Plan& plan, const Folder& folder, Registry& registry, const PoolOptions& options,
       const std::atomic<bool>& stop, const std::function<void(const PoolProgress&)>& progress)
      : plan_(plan),
        folder_(folder),
        registry_(registry),
        options_(options),
        stop_(stop),
        progress_(progress),
        shared_(options.jobs),
        workers_(static_cast<std::size_t>(options.jobs)),
        attempts_(plan.runs.size(), 0) {}

  PoolOutcome run() {
    for (int round = 0; round < most_rounds; ++round) {
      const bool first = round == 0;
      list_units(first);
      if (units_.empty() || stopped() || !outcome_.problems.empty()) return finished();
      go_round();
    }
    list_units(false);
    if (!units_.empty() && !stopped() && outcome_.problems.empty()) {
      outcome_.problems.push_back(std::to_string(units_.size()) + " units of work ended without a result");
    }
    return finished();
  }

 private:
  struct Worker {
    pid_t process = -1;
  };

  bool stopped() const { return stop_.load(); }

  PoolOutcome finished() {
    outcome_.stopped = stopped();
    outcome_.solved = shared_.board().solved.load();
    return std::move(outcome_);
  }

  void note(const std::string& problem) {
    if (std::find(outcome_.problems.begin(), outcome_.problems.end(), problem) == outcome_.problems.end()) {
      outcome_.problems.push_back(problem);
    }
  }

  /// The units of this shard in which something is missing.
  void list_units(bool first) {
    units_.clear();
    for (std::size_t u = 0; u < plan_.units.size(); ++u) {
      if (static_cast<int>(u) % options_.shards != options_.shard - 1) continue;
      int missing = 0;
      for (const int run : plan_.units[u].runs) missing += is_stored(plan_.units[u], run) ? 0 : 1;
      if (missing > 0) units_.push_back(static_cast<int>(u));
      if (!first) continue;
      const int runs = static_cast<int>(plan_.units[u].runs.size());
      outcome_.runs += runs;
      outcome_.found += runs - missing;
    }
  }

  bool is_stored(const Unit& unit, int run) {
    RunRecord record;
    std::string why;
    const Stored stored = folder_.load(plan_.runs[static_cast<std::size_t>(run)].hash, record, why);
    if (stored == Stored::damaged) note(why);
    return stored == Stored::whole && is_complete(plan_, folder_, run, record, keeps_document(unit));
  }

  bool keeps_document(const Unit& unit) const { return options_.keep_documents || unit.runs.size() > 1; }

  void go_round() {
    shared_.board().next.store(0);
    const int processes = std::min(options_.jobs, static_cast<int>(units_.size()));
    std::fflush(nullptr);  // what is buffered would be written by every process
    for (int i = 0; i < processes; ++i) start(static_cast<std::size_t>(i), -1);
    while (any_works()) {
      std::this_thread::sleep_for(look_every);
      if (stopped()) shared_.board().stop.store(true);
      end_overdue();
      end_those_that_do_not_stop();
      collect();
      tell();
    }
    shared_.board().stop.store(false);
  }

  bool any_works() const {
    return std::any_of(workers_.begin(), workers_.end(), [](const Worker& worker) { return worker.process > 0; });
  }

  /// `first_unit`: of a replacement, what its forerunner left undone; -1: none.
  void start(std::size_t i, int first_unit) {
    Desk& desk = shared_.desk(i);
    desk.run.store(-1);
    desk.finished.store(false);
    desk.has_problem.store(false);
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) ::_exit(0);  // it had ended before that
      work(desk, first_unit);
    }
    if (process < 0) note(std::string("no process can be started: ") + std::strerror(errno));
    workers_[i].process = process;
  }

  /// In the worker's process; does not return.
  [[noreturn]] void work(Desk& desk, int first_unit) {
    std::signal(SIGINT, SIG_IGN);  // a terminal sends it to all; the parent says when to stop
    std::signal(SIGTERM, SIG_DFL);
    std::string problem;
    try {
      problem = work_through(desk, first_unit);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (!problem.empty()) {
      std::snprintf(desk.problem, sizeof desk.problem, "%s", problem.c_str());
      desk.has_problem.store(true);
      shared_.board().stop.store(true);
    }
    desk.run.store(-1);
    desk.finished.store(true);
    ::_exit(0);  // nothing of the parent's is to be tidied up here
  }

  std::string work_through(Desk& desk, int first_unit) {
    Board& board = shared_.board();
    Claims claims;
    if (const Status status = claims.open(folder_.file("claims.lock")); !status.ok()) return status.text;
    UnitWork::Hooks hooks;
    hooks.go_on = [&board] { return !board.stop.load(); };
    hooks.begins = [&desk](int run) {
      desk.since.store(milliseconds_now());
      desk.run.store(run);
    };
    hooks.stored = [&](const RunRecord& record) {
      desk.run.store(-1);
      ++board.solved;
      if (record.status == "converged") ++board.converged;
    };
    UnitWork unit_work(plan_, folder_, options_.keep_documents, registry_, claims, std::move(hooks));
    std::vector<int> busy;
    std::string problem;
    const auto carry_out = [&](int unit, bool wait) {
      const UnitWork::Outcome outcome = unit_work.carry_out(plan_.units[static_cast<std::size_t>(unit)], wait, problem);
      if (outcome == UnitWork::Outcome::busy) busy.push_back(unit);
      return outcome == UnitWork::Outcome::done || outcome == UnitWork::Outcome::busy;
    };
    if (first_unit >= 0 && !carry_out(first_unit, true)) return problem;
    for (int place = board.next++; place < static_cast<int>(units_.size()); place = board.next++) {
      if (!carry_out(units_[static_cast<std::size_t>(place)], false)) return problem;
    }
    for (std::size_t i = 0; i < busy.size(); ++i) {
      if (!carry_out(busy[i], true)) return problem;
    }
    return "";
  }

  void collect() {
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      int status = 0;
      if (workers_[i].process <= 0 || ::waitpid(workers_[i].process, &status, WNOHANG) == 0) continue;
      workers_[i].process = -1;
      Desk& desk = shared_.desk(i);
      if (desk.has_problem.load()) note(desk.problem);
      if (desk.finished.load() || stopped() || shared_.board().stop.load()) continue;
      take_over(i, desk.run.load(), end_of_process(status));
    }
  }

  /// A worker is gone, with the run that it had: only a complete record counts, whatever it ended with.
  void take_over(std::size_t i, int run, const std::string& how) {
    if (run < 0 && ++idle_deaths_ > most_idle_deaths) {
      return note("processes end before they have solved anything, the last one with " + how);
    }
    const int unit = run < 0 ? -1 : unit_of(run);
    if (run >= 0 && (overdue_.count(run) > 0 || ++attempts_[static_cast<std::size_t>(run)] >= most_attempts)) {
      const std::string problem = give_up(run, plan_.units[static_cast<std::size_t>(unit)], how);
      if (!problem.empty()) return note(problem);
    }
    start(i, unit);
  }

  /// The run's result is that it fails, unless it was stored in the last moment, or another command has taken it on.
  std::string give_up(int run, const Unit& unit, const std::string& how) {
    const std::string& hash = plan_.runs[static_cast<std::size_t>(run)].hash;
    Claims claims;
    if (const Status status = claims.open(folder_.file("claims.lock")); !status.ok()) return status.text;
    if (!claims.take(hash)) return "";
    RunRecord record;
    std::string why;
    const Stored stored = folder_.load(hash, record, why);
    if (stored == Stored::damaged) return why;
    if (stored == Stored::whole && is_complete(plan_, folder_, run, record, keeps_document(unit))) return "";
    const bool overdue = overdue_.count(run) > 0;
    record = failed_run(
        plan_, run,
        overdue ? "it took longer than its time limit" : "the process that solved it ended with " + how + ", twice");
    if (overdue) record.time_limit = plan_.study.time_limit;
    if (const Status status = folder_.store(record, ""); !status.ok()) return status.text;
    ++shared_.board().solved;
    return "";
  }

  int unit_of(int run) const {
    for (std::size_t u = 0; u < plan_.units.size(); ++u) {
      const std::vector<int>& runs = plan_.units[u].runs;
      if (std::find(runs.begin(), runs.end(), run) != runs.end()) return static_cast<int>(u);
    }
    return -1;
  }

  void end_overdue() {
    if (!(plan_.study.time_limit > 0.0)) return;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      const int run = shared_.desk(i).run.load();
      const double seconds = 1e-3 * static_cast<double>(milliseconds_now() - shared_.desk(i).since.load());
      if (workers_[i].process <= 0 || run < 0 || seconds < plan_.study.time_limit) continue;
      overdue_.insert(run);
      ::kill(workers_[i].process, SIGKILL);
    }
  }

  /// Within an iteration nobody hears of a stop. Nothing is lost with a process: what it stores is whole or not there.
  void end_those_that_do_not_stop() {
    if (!shared_.board().stop.load()) {
      stop_seen_ = Clock::now();
    } else if (Clock::now() - stop_seen_ > patience) {
      for (const Worker& worker : workers_) {
        if (worker.process > 0) ::kill(worker.process, SIGKILL);
      }
    }
  }

  void tell() {
    PoolProgress now;
    now.runs = outcome_.runs;
    now.solved = shared_.board().solved.load();
    now.done = outcome_.found + now.solved;
    now.converged = shared_.board().converged.load();
    now.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    progress_(now);
  }

  const Plan& plan_;
  const Folder& folder_;
  Registry& registry_;
  const PoolOptions options_;
  const std::atomic<bool>& stop_;
  const std::function<void(const PoolProgress&)>& progress_;
  SharedBoard shared_;
  std::vector<Worker> workers_;
  std::vector<int> attempts_;  // per run: processes that it has cost
  int idle_deaths_ = 0;
  std::set<int> overdue_;
  std::vector<int> units_;
  PoolOutcome outcome_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point stop_seen_ = begin_;
};

}  // namespace

PoolOutcome run_pool(const Plan& plan, const Folder& folder, Registry& registry, const PoolOptions& options,
                     const std::atomic<bool>& stop, const std::function<void(const PoolProgress&)>& progress) {
  return Pool(plan, folder, registry, options, stop, progress).run();
}

}  // namespace bowstring::study
