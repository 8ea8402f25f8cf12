// Where variant S cuts a ray into slices.
#pragma once
#include <vector>

#include "methods/fogshop/homogeneous_airlight.h"
#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

// weight (angle of a point - first), the angle against the normal from the light to the ray.
struct AngleShare {
  double along, h, first, weight;
};

// Working memory of one thread.
struct EdgeScratch {
  std::vector<double> angle, node, share;
  std::vector<double> weight, slope, offset;  // of the boxes
  std::vector<AngleShare> lights;
  std::vector<int> bucket, rank, before;
};

// Places slices + 1 edges t[0] = lo < ... < t[slices] = hi (edges may coincide) at equal steps of a mixture of
// distributions over the ray: even in t; even in the angle as seen from each light; and, if `boxes` are given
// (placement "S3"), even over a box of 1.6 widths to both sides of each crossed Gaussian, weighted with the light that
// it takes away. Lights nearer than 1e-9 m to the ray count as 1e-9 m away. `t` has room for 8 more.
void place_edges(double lo, double hi, const std::vector<LightFromRay>& lights, const Crossings* boxes, int slices,
                 EdgeScratch&, double* t);

}  // namespace airlight::fogshop
