#include "scene/base/limits.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>

#include "scene/base/error.h"
#include "scene/base/printable.h"

namespace airlight::scene {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double gib = double(1 << 30), unlimited = std::numeric_limits<double>::infinity();
constexpr double long_work = 60;  // [s] that are told

double bytes_allowed = unlimited, allowed_seconds = unlimited;
Clock::time_point began;
std::function<void(const std::string&)> tell;

// Where `path` holds a number, that.
double number_in(const char* path) {
  double value = 0;
  return std::ifstream(path) >> value ? value : unlimited;
}

double bytes_of_machine() {
  const double all = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  return std::min({all, number_in("/sys/fs/cgroup/memory.max"), limited ? double(limit.rlim_cur) : unlimited});
}

double bytes_held() {
  double pages = 0;
  std::ifstream in("/proc/self/statm");
  return in >> pages >> pages ? pages * double(sysconf(_SC_PAGE_SIZE)) : 0;
}

double seconds_spent() { return std::chrono::duration<double>(Clock::now() - began).count(); }

std::string duration(double seconds) {
  if (seconds < 600) return fmt::format("{:.3g} s", seconds);
  if (seconds < 36000) return fmt::format("{:.0f} min", seconds / 60);
  return seconds < 360000 ? fmt::format("{:.0f} h", seconds / 3600) : fmt::format("{:.3g} days", seconds / 86400);
}

}  // namespace

void set_limit(const std::string& text) {
  double value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(stop, text.data() + text.size());
  const double bytes = unit == "GiB" ? gib : unit == "MiB" ? gib / 1024 : 0;
  const double seconds = unit == "s" ? 1 : unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  if (code != std::errc() || !(value > 0 && std::isfinite(value)) || (bytes == 0 && seconds == 0))
    throw Error(fmt::format("--limit {}: expected an amount with GiB, MiB, s, min or h, e.g. 2GiB or 10min",
                            printable(text, 100)));
  if (bytes > 0) bytes_allowed = value * bytes;
  if (seconds > 0) allowed_seconds = value * seconds;
  began = Clock::now();
}

void reset_limits() { bytes_allowed = allowed_seconds = unlimited; }

double seconds_allowed() { return allowed_seconds; }

void on_long_work(std::function<void(const std::string&)> say) { tell = std::move(say); }

void require_memory(double bytes, const std::string& what) {
  if (!(bytes > gib / 16)) return;  // not worth a look at what is held
  const bool limited = bytes_allowed < unlimited;
  const double most = limited ? bytes_allowed : bytes_of_machine();
  if (bytes + bytes_held() > most)
    throw Error(fmt::format("{}: would take this program to about {:.3g} GiB of memory, {} {:.3g}", what,
                            (bytes + bytes_held()) / gib, limited ? "--limit allows" : "this machine has", most / gib));
}

void require_time(double seconds, const std::string& what) {
  if (seconds > allowed_seconds - (allowed_seconds < unlimited ? seconds_spent() : 0))
    throw Error(
        fmt::format("{}: takes about {}, --limit allows {}", what, duration(seconds), duration(allowed_seconds)));
  if (allowed_seconds == unlimited && seconds > long_work && tell)
    tell(fmt::format("{}: takes about {}; --limit 10min would refuse what takes longer than that", what,
                     duration(seconds)));
}

bool time_is_over() { return allowed_seconds < unlimited && seconds_spent() > allowed_seconds; }

std::string over_time_text() {
  return fmt::format("not done after {}, which is what --limit allows", duration(allowed_seconds));
}

}  // namespace airlight::scene
