// A line on standard error that says how far a job is and how long it will take. On a terminal it is written over again;
// elsewhere it is said every half minute.
#pragma once
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments {

// Writes the line of progress on the terminal, cut to its width, in place of the one that is there.
void draw_progress(std::FILE* terminal, const std::string& line);

// Takes that line away for as long as this lives, so that other lines can be written where it was.
class ProgressHidden {
 public:
  ProgressHidden();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

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
  void hold_to_limit(double fraction, double spent) const;

  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  std::mutex mutex_;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace airlight::experiments
