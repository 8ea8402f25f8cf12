// A flow that is simulated on a thread of its own while somebody watches, and that a pointer stirs.
//
// A stroke becomes a force of the flow (scene::Push) that acts during the next step. So the list of forces alone decides what the flow does,
// and a flow file with these forces gives the same flow, bit for bit.
#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "experiments/application/frames.h"
#include "scene/flow/flow.h"

namespace airlight::experiments::serve {

// What `airlight simulate` takes to start a flow.
struct FlowChoice {
  std::string file;
  scene::Overrides overrides;
  std::string method = "stable_fluids";
  std::map<std::string, std::string> settings;
};

// A straight way of the pointer. The air within `radius` of its middle gets `speed` along it, if nothing else acts and the way is as long as
// the ball around it is wide; a shorter way gives a part of this speed.
struct Stroke {
  Point3 from = Point3::Zero(), to = Point3::Zero();  // [m]
  double radius = 1;                                  // [m]
  double speed = 1;                                   // [m/s]
};

// The smoke after a step.
struct Smoke {
  long long number = 0;  // another one for each step and each start
  double time = 0;       // [s]
  scene::DensityField density;
};

enum class FlowOrder {
  play,
  pause,
  step,    // one step, then pause
  reset,   // from the start, without strokes
  replay,  // from the start, with the strokes at their times
};

struct FlowState {
  long long number = 0;  // of the smoke
  long long steps = 0;
  double time = 0;  // [s]
  bool playing = false;
  double pace = 1;          // simulated seconds in a second, at most; 0: as many as it can
  double step_seconds = 0;  // median of the last 30 steps [s]; 0 before the first
  std::size_t strokes = 0;  // forces that strokes made
  std::string message;      // why it stopped, or why a stroke was refused; empty: neither
};

class LiveFlow {
 public:
  // Throws Error, NotSupported: the file, the method, its settings; methods of the device, whose threads cannot be changed.
  LiveFlow(const FlowChoice&, int threads);
  ~LiveFlow();

  const FlowChoice& choice() const { return choice_; }
  const scene::FlowProblem& problem() const { return *problem_; }
  double dt() const { return steps_.dt; }  // of a step [s]

  // A flow that nobody watches does not play.
  void watched(bool);
  // Waits until the smoke has another number, at most this long.
  FlowState state(long long known, std::chrono::milliseconds most) const;
  std::shared_ptr<const Smoke> smoke() const;

  void order(FlowOrder);
  void set_pace(double);
  // Throws Error where there are too many strokes, or this one is too small, too large or not in the box.
  void stir(const Stroke&);
  // A flow file with the strokes as forces, whose first lines say how `airlight simulate` runs it with pictures of a scene.
  std::string script(const std::string& scene_file) const;

 private:
  using Clock = std::chrono::steady_clock;
  using Lock = std::unique_lock<std::mutex>;

  void work();
  void start(Lock&);
  void advance(Lock&);
  std::vector<scene::Push> pushes_now(double time);
  void keep_smoke();
  void fail(const std::string& message);

  FlowChoice choice_;
  std::shared_ptr<const scene::FlowProblem> problem_;
  const scene::Solver& solver_;
  scene::Settings settings_;
  scene::Execution execution_;
  FrameSteps steps_;

  mutable std::mutex mutex_;
  mutable std::condition_variable wake_, moved_;
  FlowState state_;
  std::shared_ptr<const Smoke> smoke_;
  std::vector<Stroke> waiting_;       // for the next step
  std::vector<scene::Push> strokes_;  // that acted
  std::deque<double> last_seconds_;
  bool watched_ = false, stopping_ = false, start_ = false, one_step_ = false, broken_ = false;
  Clock::time_point next_{};  // earliest time of the next step

  std::unique_ptr<scene::Flow> flow_;  // the thread's own

  std::thread thread_;
};

}  // namespace airlight::experiments::serve
