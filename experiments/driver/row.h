// One line of a table: one method at one setting on one scene, with its errors, times and counts.
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/application/probe.h"
#include "experiments/driver/next_frames.h"
#include "experiments/judging/metrics.h"
#include "experiments/judging/statistics.h"

namespace airlight::experiments {

struct Row {
  std::string key;          // content of everything that the row depends on
  std::string figures_key;  // content of everything that its figures depend on: without processor and rule of timing
  std::string scene, method, setting, renderer, settings, layer;
  std::string scene_hash, reference_key;
  std::optional<double> parameter;
  std::vector<Measure> measures;
  std::string left_out;       // what the picture lacks (left_out.h), where the experiment asks
  std::string note;           // why there are no figures: the method cannot render this scene
  bool unavailable = false;   // they need hardware or a library that is not here, and that nobody asked for by name
  int width = 0, height = 0;  // pixels of the scene's film
  int runs = 0;               // timed runs; 0: not rendered
  Estimate seconds{0, 0, 0};  // median wall time of one render, interval by ranks
  double coverage = 0;        // of that interval
  double mad = 0;             // [s], times 1.4826
  std::vector<double> times;  // [s] of each run; of rows of one `group` in the same rounds
  std::string group;          // rows that were timed together have the same
  double waited = 0;          // share of the threads' time in these runs in which no processor was free for them
  double prepare_seconds = 0;
  std::map<std::string, FrameAfter> moved;             // by what moved: "camera", "lights", "media"
  std::vector<std::pair<std::string, double>> stages;  // [s] of one render, median of the runs
  std::string device;                                  // that computed it, if not the processor
  std::map<std::string, double> counters;
  std::string image;  // file below images/ of the results, without extension; empty: it has no picture
  std::optional<FigureMap> map;
  Columns columns;
  double exposure = 0;
  std::string made_on;  // computer and processor; kept by journals alone
};

// Takes away all that the row says of times.
void forget_times(Row&);

// The stage of a device's row that its time of one render leaves out: layers of the film on their way to the host.
inline constexpr const char* download_stage = "download";

// Whether a row's device is a software renderer, whose times are not those of a GPU.
bool is_processor(const std::string& device);

nlohmann::json to_json(const Row&);
Row row_from_json(const nlohmann::json&);

// A metric, "seconds", "prepare_seconds", "total_seconds" (the sum of both), "parameter", "setting" or "counter.NAME"; "camera_seconds", "lights_seconds" and
// "media_seconds", of the frame after these moved; of a
// flow "step_seconds" (of one step), "cell_seconds" (of one step, over its cells) and "simulated_seconds" (of one simulated
// second). Nothing where the row has none.
std::optional<Estimate> quantity(const Row&, const std::string& name);

}  // namespace airlight::experiments
