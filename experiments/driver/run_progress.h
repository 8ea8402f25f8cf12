// The line that says how far a run of experiments is and how long all of it will still take: on a terminal at the foot
// of the screen, elsewhere now and then among the other lines.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "experiments/driver/time_left.h"
#include "scene/renderer.h"

namespace airlight::experiments {

class RunProgress {
 public:
  struct Streams {
    std::FILE* terminal;  // null: there is none
    std::FILE* lines;     // null: nothing is said
    bool starts = true;   // a line for each experiment that begins
    double pause = 30;    // [s] between other lines where there is no terminal
  };
  // The terminal is standard error if that is one; lines go to standard output.
  static Streams standard_streams(bool starts);

  explicit RunProgress(std::vector<PlannedWork>, const Streams& = standard_streams(true));
  ~RunProgress();

  // The next experiment begins, or all have ended. The remaining work of the previous one is dropped.
  void begin(std::size_t experiment);
  void end();

  // [s] of the experiment that is under way.
  double work_of_rows() const { return planned_.at(current_).rows; }
  double work_of_reference(const std::string& scene) const;
  void spare(double work);

  // A piece of that work, done when this ends; one at a time.
  class Step {
   public:
    Step(RunProgress&, std::string what, double work);
    ~Step();
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

    void update(double share) { progress_.share_ = share; }  // in [0, 1]; from any thread
    void spare() { spared_ = true; }                         // there was nothing to do
    // Shows progress and stops on a signal.
    scene::Execution execution(int threads);

   private:
    RunProgress& progress_;
    bool spared_ = false;
  };

  // "[3 of 148] fogshop/fig4_smooth (quick): S 12 on f100, 40 %; about 21 min left"
  std::string line() const;

 private:
  void spare_locked(double work);
  std::string line_locked(bool start) const;
  void tick(const std::stop_token&);

  const std::vector<PlannedWork> planned_;
  const Streams streams_;
  mutable std::mutex mutex_;
  TimeLeft time_left_;
  std::size_t current_ = 0;
  bool under_way_ = false;  // an experiment is
  double open_ = 0;         // work of the current experiment, neither done nor spared
  std::string what_;        // the step; empty between steps
  double piece_ = 0, since_ = 0;
  std::atomic<double> share_{0};
  double last_line_ = 0;
  std::condition_variable_any wake_;
  std::jthread ticker_;
};

}  // namespace airlight::experiments
