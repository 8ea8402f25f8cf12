#include "experiments/application/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::experiments {
namespace {

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  if (seconds < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(seconds / 60), std::fmod(seconds, 60));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(seconds / 3600), std::fmod(seconds, 3600) / 60);
}

// One line for the whole program: whoever draws last is seen.
std::recursive_mutex line_mutex;
std::FILE* line_is_on = nullptr;

}  // namespace

void draw_progress(std::FILE* terminal, const std::string& line) {
  const std::lock_guard lock(line_mutex);
  winsize size{};
  const bool known = ioctl(fileno(terminal), TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  // A terminal that went away is no reason to stop: nothing is thrown.
  std::fputs(("\r\033[K" + (known ? line.substr(0, size.ws_col - 1u) : line)).c_str(), terminal);
  std::fflush(terminal);
  line_is_on = terminal;
}

ProgressHidden::ProgressHidden() : lock_(line_mutex) {
  if (!line_is_on) return;
  std::fputs("\r\033[K", line_is_on);
  std::fflush(line_is_on);
  line_is_on = nullptr;
}

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO)), start_(Clock::now()), last_(start_) {}

Progress::~Progress() {
  if (shown_) const ProgressHidden hidden;
}

void Progress::update(double fraction) {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (scene::seconds_allowed() < infinity) hold_to_limit(fraction, std::chrono::duration<double>(now - start_).count());
  if (std::chrono::duration<double>(now - last_).count() < (terminal_ ? 0.1 : 30)) return;
  last_ = now;
  shown_ = terminal_;
  const double spent = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("{}: {:.0f} %", what_, 100 * fraction);
  if (fraction > 0.01 && spent > 1) line += fmt::format(", {} left", duration(spent * (1 - fraction) / fraction));
  if (terminal_)
    draw_progress(stderr, line);
  else
    say(line);
}

// Extrapolates the remaining time after the first second, and stops if it is above the limit.
void Progress::hold_to_limit(double fraction, double spent) const {
  if (spent < 1 || scene::time_is_over()) return;
  try {
    if (fraction > 0) scene::require_time(spent * (1 - fraction) / fraction, what_);
  } catch (const Error& error) {
    stop_with(error.what());
  }
}

scene::Execution Progress::execution(int threads) {
  return {threads, [this](double fraction) {
            update(fraction);
            return !interrupted();
          }};
}

}  // namespace airlight::experiments
