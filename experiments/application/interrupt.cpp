#include "experiments/application/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <mutex>

#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::experiments {
namespace {

std::atomic<int> signals{0};
std::atomic<bool> stopped{false}, end_of_rows{false};
std::mutex reason_mutex;
std::string reason;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int) {
  if (++signals > 1) _exit(130);
}

extern "C" void on_end_of_rows(int) { end_of_rows = true; }

// SA_RESTART: a read or a write that the signal interrupts goes on afterwards.
void install(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_end_of_rows() { install(SIGUSR1, on_end_of_rows); }

bool rows_end() { return end_of_rows; }

void catch_interrupts() {
  install(SIGINT, on_signal);
  install(SIGTERM, on_signal);
  // Ignored under nohup.
  struct sigaction hangup {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) install(SIGHUP, on_signal);
}

bool interrupted() { return signals.load() > 0 || stopped || scene::time_is_over(); }

void stop_with(const std::string& why) {
  const std::lock_guard lock(reason_mutex);
  if (!stopped) reason = why;
  stopped = true;
}

std::string stopped_by() { return !reason.empty() || !scene::time_is_over() ? reason : scene::over_time_text(); }

void check_interrupted() {
  if (stopped) throw Error(reason);
  if (interrupted()) throw scene::Interrupted("interrupted");
}

scene::Execution quiet_execution(int threads) {
  return {threads, [](double) { return !interrupted(); }};
}

}  // namespace airlight::experiments
