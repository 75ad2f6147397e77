#include "apps/watched_run.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <functional>

#include <unistd.h>

namespace bowstring::apps {

namespace {

std::atomic<bool> interrupted{false};

extern "C" void on_interrupt(int) { interrupted.store(true); }

class Progress {
 public:
  bool operator()(const IterationRecord& record) {
    if (terminal_) {
      std::fprintf(stderr, "\r\033[Kiteration %3d   energy %.6g N mm   stationarity %.1e N   rows %.1e mm   step %.2g",
                   record.iteration, record.energy, record.stationarity, record.penetration, record.step);
      std::fflush(stderr);
    }
    return !interrupted.load();
  }
  void finish() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

}  // namespace

std::vector<StateResult> run_watched(Procedure& procedure) {
  std::signal(SIGINT, on_interrupt);
  Progress progress;
  std::vector<StateResult> states = procedure.run(std::ref(progress));
  progress.finish();
  std::signal(SIGINT, SIG_DFL);
  return states;
}

}  // namespace bowstring::apps
