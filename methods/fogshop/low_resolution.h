// Section 5.4 of Zhou et al. 2007: airlight and optical depth at a lower resolution, brought back to that of the film
// with an eye on the distances. Surfaces and the final combination are not touched by it.
#pragma once
#include <vector>

#include "methods/fogshop/airlight_pass.h"

namespace airlight::fogshop {

// The film and its low-resolution picture: a low pixel covers factor x factor pixels, the last ones of a row or column
// maybe fewer. It stands for the ray through the middle of its block; film distances are in pixels.
struct LowResolution {
  int width, height;  // of the film
  int factor;         // 1, 2 or 4, per axis

  int low_width() const { return (width + factor - 1) / factor; }
  int low_height() const { return (height + factor - 1) / factor; }
};

// Where the rays of the low pixels end [m], each its own: not the least nor the mean over its block.
std::vector<double> low_distances(const scene::Scene&, const scene::View&, const LowResolution&,
                                  const scene::Execution&);

// 1 for the pixels "whose full-resolution neighborhood spans too great a range in the depth map": the greatest distance
// among the (factor + 1)^2 pixels around it (factor >= 2; its own alone at 1) and the four low pixels that it lies
// between is more than 1.1 times the least. Distances may be infinite.
std::vector<unsigned char> edge_pixels(const LowResolution&, const std::vector<double>& low_distance,
                                       const std::vector<double>& distance);

// Bilinear interpolation of airlight and depth, clamped at the borders of the film. Pixels with an `edge` of 1 are
// copied instead from the one of the four neighbours whose distance is closest to theirs, of equals the closest one.
// `edge` may be empty: none. Depths above 1e30 are 1e30: everything is black behind them.
AirlightImage upsample(const LowResolution&, const AirlightImage& low, const std::vector<unsigned char>& edge,
                       const std::vector<double>& low_distance, const std::vector<double>& distance);

// All of it as the settings want it: `distance` is d_vp of the film, `surfaces_end_rays` says whether any is finite.
// Appends what it did to times and counters.
AirlightImage low_resolution_airlight(const scene::Scene&, const Model&, const ViewModel&, const scene::View&,
                                      const std::vector<double>& distance, bool surfaces_end_rays,
                                      const scene::Execution&, std::vector<scene::StageTime>& times,
                                      std::map<std::string, double>& counters);

}  // namespace airlight::fogshop
