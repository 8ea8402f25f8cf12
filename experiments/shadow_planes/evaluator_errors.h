// Where the evaluators of the airlight integral hold: the paper's polynomial and the mapped rule against 128 nodes in
// double precision, over extinction and distance, over angles, and against time.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "gpu/context.h"

namespace airlight::experiments::shadow_planes {

// The map: the light's foot point lies 5 m from the eye; lit are 1 to 2, 4 to 6 and 8 to 9 m: before, around and behind
// it.
inline constexpr double map_foot = 5;
inline const std::array<std::array<double, 2>, 3> map_parts = {{{1, 1}, {4, 2}, {8, 1}}};  // begin, length

const std::vector<std::string>& map_evaluators();  // titles of MapCell::error

struct MapCell {
  double extinction, h;  // rounded to single precision
  std::vector<double>
      error;         // greatest relative error of the parts that are normal numbers of the precision; NaN: none
  double own_error;  // of the reference: 128 nodes against 256
};
MapCell map_cell(double extinction, double h);
// Extinction 1e-6 to 1e4 [1/m], h 1e-6 to 1e3 [m], `per_decade` cells each; h fastest.
std::vector<MapCell> stability_map(int per_decade);

// Relative error of the polynomial's integral about theta = 0 over random angles in [-reach, reach], a log-uniform, in
// double precision: section 3 of the method's specification.
struct AngleRow {
  double reach, a_low, a_high;
  struct Error {
    double median, p99;
  };
  std::vector<Error> error;  // by `angle_degrees`
};
inline constexpr std::array<int, 5> angle_degrees = {2, 4, 6, 8, 12};
std::vector<AngleRow> errors_over_angles(int cases);

// Endless rays over 0 to 90 degrees from the light: rms error over mean radiance, by `angle_degrees`.
struct ImageRow {
  double optical_distance;  // of the light
  std::vector<double> error;
};
std::vector<ImageRow> errors_over_image(int rays);

// Error and time of one evaluation on lit parts in fog that the light is 0.1 to 3 optical lengths away in.
struct TimedRow {
  std::string evaluator, precision;
  int setting;  // degree or nodes
  double median, p99, greatest;
  double nanoseconds;  // of one thread of the processor, or of the whole device; the best of several runs
};
// `device` null: on the processor alone.
std::vector<TimedRow> errors_and_times(int cases, int runs, gpu::Context* device);

}  // namespace airlight::experiments::shadow_planes
