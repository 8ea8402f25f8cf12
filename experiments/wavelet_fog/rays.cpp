#include "experiments/wavelet_fog/rays.h"

#include <cmath>

#include "scene/base/error.h"
#include "scene/media/fogmap.h"

namespace airlight::experiments {

MapRays map_rays(const std::filesystem::path& file, const scene::Overrides& overrides, int angles, double depth) {
  if (file.empty()) throw Error("the probe needs a [[scene]] with a fogmap");
  const scene::Scene scene = scene::load_scene(file.string(), overrides);
  if (scene.media.empty() || !std::holds_alternative<scene::FogmapPointer>(scene.media[0].field))
    throw Error(scene.name + ": the probe needs a fogmap as first medium");
  MapRays rays;
  rays.map = std::get<scene::FogmapPointer>(scene.media[0].field)->map;
  // Eyes as shares of the map's sides: three outside the fog, three within.
  const double eyes[][2] = {{0.5, -0.08}, {-0.08, 0.31}, {1.09, 1.09}, {0.16, 0.16}, {0.51, 0.49}, {0.78, 0.31}};
  const double lengths[] = {4, 15, 40, 75, 130};
  double sum = 0;
  int met = 0;
  for (const auto& eye : eyes)
    for (int a = 0; a < angles; ++a)
      for (const double length : lengths) {
        const double angle = 2 * pi * (a + 0.37) / angles;
        rays.lines.push_back({rays.map.support_lo(0) + eye[0] * (rays.map.support_hi(0) - rays.map.support_lo(0)),
                              rays.map.support_lo(1) + eye[1] * (rays.map.support_hi(1) - rays.map.support_lo(1)), 0,
                              std::cos(angle), std::sin(angle), 0});
        rays.lengths.push_back(length);
        const double column = scene::integral(rays.map, scene::SameAtAllHeights{}, rays.lines.back(), {0, length});
        sum += column;
        met += column > 0 ? 1 : 0;
      }
  if (met == 0) throw Error(scene.name + ": no ray meets the fog");
  rays.sigma = depth * met / sum;
  return rays;
}

}  // namespace airlight::experiments
