#include "experiments/driver/run_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "experiments/application/interrupt.h"
#include "experiments/application/progress.h"
#include "experiments/driver/timing.h"

namespace airlight::experiments {
namespace {

constexpr std::chrono::milliseconds between_ticks{500};

double total(const std::vector<PlannedWork>& planned) {
  double sum = 0;
  for (const PlannedWork& work : planned) sum += work.total();
  return sum;
}

}  // namespace

RunProgress::Streams RunProgress::standard_streams(bool starts) {
  return {isatty(STDERR_FILENO) ? stderr : nullptr, stdout, starts};
}

RunProgress::RunProgress(std::vector<PlannedWork> planned, const Streams& streams)
    : planned_(std::move(planned)), streams_(streams), time_left_(total(planned_)), last_line_(steady_seconds()) {
  if (streams_.terminal || streams_.lines) ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
}

RunProgress::~RunProgress() {
  if (ticker_.joinable()) {
    ticker_.request_stop();
    ticker_.join();
  }
  if (streams_.terminal) const ProgressHidden hidden;
}

void RunProgress::begin(std::size_t experiment) {
  end();
  const std::lock_guard lock(mutex_);
  current_ = experiment;
  under_way_ = true;
  open_ = planned_.at(current_).total();
  if (!streams_.starts || !streams_.lines) return;
  const ProgressHidden hidden;
  fmt::print(streams_.lines, "{}\n", line_locked(true));
  std::fflush(streams_.lines);
  last_line_ = steady_seconds();
}

void RunProgress::end() {
  const std::lock_guard lock(mutex_);
  spare_locked(open_);
  under_way_ = false;
}

double RunProgress::work_of_reference(const std::string& scene) const {
  const auto& references = planned_.at(current_).references;
  const auto found = references.find(scene);
  return found == references.end() ? 0 : found->second;
}

void RunProgress::spare(double work) {
  const std::lock_guard lock(mutex_);
  spare_locked(work);
}

void RunProgress::spare_locked(double work) {
  work = std::min(work, open_);
  open_ -= work;
  time_left_.spared(work);
}

RunProgress::Step::Step(RunProgress& progress, std::string what, double work) : progress_(progress) {
  const std::lock_guard lock(progress.mutex_);
  progress.what_ = std::move(what);
  progress.piece_ = std::min(work, progress.open_);
  progress.since_ = steady_seconds();
  progress.share_ = 0;
}

RunProgress::Step::~Step() {
  const std::lock_guard lock(progress_.mutex_);
  if (spared_) {
    progress_.spare_locked(progress_.piece_);
  } else {
    progress_.open_ -= progress_.piece_;
    progress_.time_left_.done(progress_.piece_, steady_seconds() - progress_.since_);
  }
  progress_.what_.clear();
  progress_.piece_ = 0;
  progress_.share_ = 0;
}

scene::Execution RunProgress::Step::execution(int threads) {
  return {threads, [this](double share) {
            update(share);
            return !interrupted();
          }};
}

std::string RunProgress::line() const {
  const std::lock_guard lock(mutex_);
  return line_locked(false);
}

std::string RunProgress::line_locked(bool start) const {
  const double share = std::clamp(share_.load(), 0.0, 1.0);
  std::string line = fmt::format("[{} of {}] {}: ", current_ + 1, planned_.size(), planned_[current_].name);
  if (!what_.empty()) line += what_ + ", ";
  if (!start) line += fmt::format("{:.0f} %; ", 100 * (1 - (open_ - piece_ * share) / planned_[current_].total()));
  return line + time_left_text(time_left_.left(piece_, share, what_.empty() ? 0 : steady_seconds() - since_));
}

void RunProgress::tick(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, stop, between_ticks, [&stop] { return stop.stop_requested(); })) {
    if (!under_way_) continue;
    if (streams_.terminal) {
      draw_progress(streams_.terminal, line_locked(false));
    } else if (steady_seconds() - last_line_ >= streams_.pause) {
      // Nothing may be thrown in this thread; that the stream failed is found at the program's end.
      std::fputs((line_locked(false) + "\n").c_str(), streams_.lines);
      std::fflush(streams_.lines);
      last_line_ = steady_seconds();
    }
  }
}

}  // namespace airlight::experiments
