// From the marched film to film pixels: a bilateral blur, and upsampling that keeps to edges of depth.
#pragma once
#include "reference/half_resolution_march/low_film.h"
#include "scene/renderer.h"

namespace airlight::half_resolution_march {

constexpr int blur_radius = 5;           // [marched pixels]
constexpr double blur_sigma = 5 / 1.5;   // [marched pixels]
constexpr double upsample_edges = 0.75;  // depths of all four neighbours together, in edges

// Rows, then columns: the mean of 11 pixels with weights exp(-x^2 / (2 sigma^2) - (dz / edge)^2), x in marched pixels and dz the
// difference of depth. Pixels beside the film are left out; weights add up to 1. `edge` in metres.
void blur(LowFilm&, double edge, const scene::Execution&);

// Two neighbours of a film pixel along one side, and the share of the second. Beyond the outermost centres: the last block.
struct Neighbours {
  int first, second;
  double share;
};
Neighbours neighbours(const Blocks&, int pixel);
// Two neighbours of a film position [film pixels], like those of a film pixel.
Neighbours neighbours_at(const Blocks&, double x);

// Value at a film pixel of this depth by bilinear interpolation. With `nearest_depth`, the neighbour of nearest depth
// is used instead, where the depth differences of all four add up to more than upsample_edges * edge. Among equally
// near neighbours the one with the largest weight is used; among equal weights the first.
FogPixel upsampled(const LowFilm&, const Neighbours& across, const Neighbours& down, double depth, bool nearest_depth,
                   double edge);

}  // namespace airlight::half_resolution_march
