#include "experiments/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "experiments/interrupt.h"

namespace airlight::experiments {
namespace {

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  if (seconds < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(seconds / 3600), std::fmod(seconds, 3600) / 60);
}

}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO)), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::update(double fraction) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - last_).count() < 0.1) return;
  last_ = now;
  shown_ = true;
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("{}: {:.0f} %", what_, 100 * fraction);
  if (fraction > 0.01 && spent > 1) line += fmt::format(", {} left", duration(spent * (1 - fraction) / fraction));
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
}

scene::Execution Progress::execution(int threads) {
  return {threads, [this](double fraction) {
            update(fraction);
            return !interrupted();
          }};
}

}  // namespace airlight::experiments
