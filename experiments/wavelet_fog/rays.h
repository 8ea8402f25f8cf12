// Rays over a map that the probes of wavelet fog ask for: horizontal, from eyes outside and inside.
#pragma once
#include <filesystem>

#include "methods/wavelet_fog/levels.h"
#include "scene/scene.h"

namespace airlight::experiments {

// Wavelet families by the degree of a map.
inline constexpr const char* families[] = {"haar", "cdf22", "cdf33"};

struct MapRays {
  scene::SplineMap map;
  std::vector<scene::MapLine> lines;  // unit speed [cells]
  std::vector<double> lengths;        // [cells], of each
  double sigma = 1;                   // [per cell]: the mean optical depth of the rays that meet fog is `depth`
};

// The first fogmap of the scene file, which must have one; six eyes in its plane, `angles` directions, five lengths from 4 to 130 cells.
MapRays map_rays(const std::filesystem::path& file, const scene::Overrides&, int angles, double depth);

}  // namespace airlight::experiments
