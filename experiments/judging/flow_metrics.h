// Metrics of flows: names, and their values for one flow at one time.
//
// Metrics of the flow at the end, or at the time that a suffix names ("density.rel_l2@0.5", in seconds, a frame's):
//
//   velocity.rel_l2    sqrt(sum |u - r|^2 / sum |r|^2) over the samples, r the reference; also density. and temperature.
//   velocity.greatest  greatest |u - r| over the greatest |r|; also density. and temperature.
//
// Metrics of the flow's own samples, without a reference:
//
//   density.contrast   standard deviation of the density over that at the start: of a wave, what is left of its amplitude
//   density.asymmetry  greatest difference from its mirror image, along x and, in three dimensions, z, over the greatest
//
// Sums over the box (scene::Totals), no reference asked for:
//
//   energy_drift, mass_drift  over that at the start, less 1, signed
//   greatest_speed, center_y, enstrophy, mass   as they are
//
// Over all frames up to that time:
//
//   divergence_max     greatest divergence times a cell over the greatest speed
//   minimum, maximum   of the density
//   energy_growth      greatest energy of a frame over that of any before, less 1; 0 where it never grows
//   center_falls       greatest height that the centre of mass lost from one frame to the next [m]; 0 where it only rises
//
// Samples: the middles of 61 cells along the longest axis of the box, and as many as fit along the others; a number that
// has no factor in common with the grids of solvers, so that none is favoured.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "experiments/judging/metrics.h"
#include "scene/flow/flow.h"

namespace airlight::experiments {

struct FlowMetric {
  std::string base;
  std::optional<double> time;  // [s]; nothing: at the end
};

// Throws Error with the nearest valid name; `where` begins the message.
FlowMetric parse_flow_metric(const std::string& name, const std::string& where);
bool needs_reference(const FlowMetric&);
bool needs_samples(const FlowMetric&);

// A flow at the samples.
struct FlowSample {
  std::vector<double> velocity;  // 3 numbers each
  std::vector<double> density, temperature;
};
std::vector<Point3> sample_points(const scene::FlowProblem&);
FlowSample sample(const scene::Flow&, const std::vector<Point3>&);

// Data of a flow up to a frame: the totals of each frame, and the samples of the last.
struct FlowMoment {
  std::vector<scene::Totals> totals;
  FlowSample here;
  double deviation_at_start = 0;          // of the density: where contrast is asked for
  FlowSample mirrored[2];                 // along x and, in three dimensions, z: where asymmetry is asked for
  const FlowSample* reference = nullptr;  // of that time; null without one
};
// Standard deviation.
double deviation(const std::vector<double>&);

// NaN where it is not defined: a reference of zeros, an energy of 0 at the start, no smoke.
double flow_figure(const std::string& base, const FlowMoment&);

}  // namespace airlight::experiments
