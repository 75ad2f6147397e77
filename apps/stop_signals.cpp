#include "apps/stop_signals.hpp"

#include <csignal>

namespace bowstring::apps {

namespace {

std::atomic<bool> stop_seen{false};

extern "C" void on_stop(int) { stop_seen.store(true); }

}  // namespace

StopSignals::StopSignals(std::initializer_list<int> signals) : signals_(signals) {
  for (const int one : signals_) std::signal(one, on_stop);
}

StopSignals::~StopSignals() {
  for (const int one : signals_) std::signal(one, SIG_DFL);
}

const std::atomic<bool>& StopSignals::seen() noexcept { return stop_seen; }

}  // namespace bowstring::apps
