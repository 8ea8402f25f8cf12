// A probe measures something that is no picture: an evaluator's errors, a kernel's rate, vectors that are recomputed.
// An experiment of kind "numbers" makes a row of each run.
#pragma once
#include <filesystem>
#include <map>

#include "experiments/judging/metrics.h"
#include "experiments/judging/statistics.h"
#include "scene/base/component.h"
#include "scene/base/error.h"
#include "scene/renderer.h"

namespace airlight::experiments {

// Input of a data folder, and nobody named one.
class NoDataFolder : public Unavailable {
 public:
  using Unavailable::Unavailable;
};

// Input of a probe besides its settings: the file of the experiment's [[scene]]; empty without one.
struct ProbeInput {
  std::filesystem::path file;
  std::map<std::string, std::string> overrides;  // of a scene file
  bool quick = true;                             // profile quick: the budget of CI
};

// Values over a rectangle of cells, both axes logarithmic: drawn by a [[plot]] with map = true.
struct FigureMap {
  struct Axis {
    std::string label;
    std::vector<double> values;  // ascending, evenly spaced in their logarithm
  };
  std::string label;
  Axis x, y;
  std::vector<double> values;  // [x][y]; NaN: not defined there
  // Lines that explain it, points (x, y) each.
  std::vector<std::vector<std::array<double, 2>>> lines;
};

// Numbers in columns of one length, such as a history or a profile: drawn by a [[plot]] of "column.NAME"s.
using Columns = std::map<std::string, std::vector<double>>;

struct Findings {
  std::vector<Measure> figures;  // the defined ones of figures(), in any order
  std::string note;              // where words are needed
  std::map<std::string, double> counters;
  // Time of what is measured once, where it is one: median and interval by ranks of so many runs [s].
  Estimate seconds{0, 0, 0};
  double coverage = 0;
  int runs = 0;
  std::optional<FigureMap> map;
  Columns columns;
};

class Probe : public scene::Component {
 public:
  // Names of all figures that the probe may find: an experiment's `metrics`, plots and gates may use these names.
  virtual std::vector<std::string> figures() const = 0;
  // The figures that depend on the machine's speed, except figures named after a unit of time (probes.h).
  virtual std::vector<std::string> speeds() const { return {}; }
  // Throws Error for invalid input, Unavailable for a missing device.
  virtual Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const = 0;
};

// A figure that is known exactly, or with an interval.
inline Measure exactly(std::string name, double value) { return {std::move(name), value, value, value, 0, false}; }

// Values in another unit, such as seconds times 1e3 for milliseconds.
inline std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

// The median of runs, with its interval by ranks.
inline Measure measured(std::string name, const std::vector<double>& runs) {
  const Estimate e = median_estimate(runs);
  return {std::move(name), e.value, e.low, e.high, 0, false};
}

// The time of what a probe measures once is the median of these runs [s].
inline void set_time(Findings& found, const std::vector<double>& runs) {
  found.seconds = median_estimate(runs);
  found.runs = int(runs.size());
  found.coverage = median_ranks(found.runs).coverage;
}

}  // namespace airlight::experiments
