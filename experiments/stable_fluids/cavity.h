// Boxes whose lid moves, until the flow in them is steady: what the oracle vectors and the experiment of cavities share.
#pragma once
#include <memory>

#include "experiments/verify/entry.h"
#include "scene/flow/flow.h"

namespace airlight::experiments {

// Known velocities of one steady flow: u along x = 0.5, v along y = 0.5; either may be empty.
struct CavityProfiles {
  double reynolds = 0;
  std::vector<double> u, v;
};

// Content of an oracle vector: the profiles at heights y and at places x, for each Reynolds number.
struct CavityTable {
  std::vector<double> y, x;
  std::vector<CavityProfiles> profiles;
  // None for a Reynolds number that it has not.
  const CavityProfiles* find(double reynolds) const;
};
// Throws Error where there are not as many numbers as places.
CavityTable read_cavity_table(const verification::Value& vector);

inline Point3 on_vertical(double y) { return {0.5, y, 0}; }
inline Point3 on_horizontal(double x) { return {x, 0.5, 0}; }

struct Cavity {
  double reynolds = 100;     // of the side, 1 m, and the lid's greatest speed, 1 m/s
  bool regularized = false;  // the lid moves with 16 x^2 (1-x)^2: no jumps in the corners
  int n = 48;                // cells a side
  double cfl = 1;            // the lid's way a step, in cells
  double seconds = 25;       // from rest
};

// Steps that are enough for `unit lid` and the other: 25 s up to a Reynolds number of 100, 50 s beyond; CFL 1 up to 400,
// 0.25 beyond. Advection followed by a projection is first order in time, which shows where little else damps.
Cavity usual_cavity(double reynolds, bool regularized, int n);

struct SteadyFlow {
  std::unique_ptr<scene::Flow> flow;
  double change = 0;  // greatest, of the velocities along both middles in the last second [m/s per s]
};
SteadyFlow steady_flow(const Cavity&, const scene::Execution&);

}  // namespace airlight::experiments
