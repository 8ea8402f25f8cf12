// A line on standard error that says how far a job is and how long it will take; nothing where standard error is not a
// terminal.
#pragma once
#include <chrono>
#include <mutex>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();  // clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Fraction done in [0, 1]; from any thread; at most ten times a second reaches the terminal.
  void update(double fraction);

  // Shows progress and stops on a signal.
  scene::Execution execution(int threads);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  std::mutex mutex_;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace airlight::experiments
