// What a run of an experiment found: rows, what they were compared with, gates.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/driver/row.h"

namespace airlight::experiments {

struct ReferenceInfo {
  std::string scene, key, renderer, settings, image;
  double seconds = 0;
  bool cached = false;
  double exposure = 0;
  std::string samples;  // that a Monte Carlo reference has: a cache may hold more than were asked for
};

struct GateResult {
  std::string name;  // "fogshop/fig4: f100, P: rel_l2"
  std::string text;  // with figures
  bool passed = false;
};

struct Outcome {
  Experiment experiment;
  std::vector<Row> rows;
  std::vector<ReferenceInfo> references;
  std::vector<GateResult> gates;
  bool complete = false;  // false: interrupted
  double seconds = 0;
};

// Each gate against every row that it names: fails if the whole interval lies beyond the bound, if the figure is not
// defined, and if there is no such row.
std::vector<GateResult> judge(const Experiment&, const std::vector<Row>&);

}  // namespace airlight::experiments
