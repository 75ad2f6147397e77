#include "apps/watched_run.hpp"

#include <csignal>
#include <cstdio>
#include <functional>

#include <unistd.h>

#include "apps/stop_signals.hpp"

namespace bowstring::apps {

namespace {

class Progress {
 public:
  bool operator()(const IterationRecord& record) {
    if (terminal_) {
      std::fprintf(stderr, "\r\033[Kiteration %3d   energy %.6g N mm   stationarity %.1e N   rows %.1e mm   step %.2g",
                   record.iteration, record.energy, record.stationarity, record.penetration, record.step);
      std::fflush(stderr);
    }
    return !StopSignals::seen().load();
  }
  void finish() const {
    if (terminal_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

}  // namespace

std::vector<StateResult> run_watched(Procedure& procedure) {
  const StopSignals signals({SIGINT});
  Progress progress;
  std::vector<StateResult> states = procedure.run(std::ref(progress));
  progress.finish();
  return states;
}

}  // namespace bowstring::apps
