// A half of the comparison: a method with its settings, and the preparation that it keeps from frame to frame.
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/serve/requests.h"
#include "scene/renderer.h"

namespace airlight::experiments::serve {

// One answer to a FrameRequest.
struct Frame {
  std::string refused;  // why the method cannot render this; empty: there is a film
  std::shared_ptr<const scene::Scene> scene;
  std::shared_ptr<const scene::Film> film;
  std::optional<double> smoke_time;  // of the flow that it shows [s]; nothing without a flow
  bool noisy = false;                // the film's noise is a part of its error
  std::string prepared;              // "kept", "moved on" (Prepared::next) or "anew"
  double waited = 0;                 // [s] in the queue
  double seconds = 0;                // of what was redone and of the rendering, wall clock
  double median = 0;                 // of the last frames, at most 30, whose preparation and film were like this one
  int median_frames = 0;             // how many
  std::vector<scene::StageTime> times;
  std::vector<scene::Stage> stages;
  std::map<std::string, double> counters;
};

class Pane {
 public:
  // Throws Error for settings that are not valid, scene::Interrupted where the execution says so.
  Frame render(const FrameRequest&, const std::shared_ptr<const scene::Scene>&, const scene::Execution&);

 private:
  void prepare(const scene::Renderer&, const scene::Settings&, std::shared_ptr<const scene::Scene>,
               const scene::Execution&, Frame&);

  std::string key_;  // method and settings
  std::shared_ptr<const scene::Scene> scene_;
  std::unique_ptr<scene::Prepared> prepared_;
  std::deque<std::pair<std::string, double>> last_;  // what was redone on which film, and seconds
};

}  // namespace airlight::experiments::serve
