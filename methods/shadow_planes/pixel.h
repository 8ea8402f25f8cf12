// Pixels, as the stages of a picture pass them on.
#pragma once
#include "scene/picture.h"

namespace airlight::shadow_planes {

// Seconds by stage of section 5.1; the silhouettes, stage 1, are found when a scene is prepared.
struct StageSeconds {
  double scene = 0, ends = 0, sort = 0, planes = 0;  // 2 to 5
};

struct Counts {
  double parts = 0,
         crossings = 0;  // evaluations by pixel of lit parts or of Gamma, or looked up at vertices; planes met
  double by_pixel = 0;   // of the parts, evaluated for their pixel
};

struct Pixel : scene::Pixel {
  Ray ray;
  scene::RayEnd end;
};

}  // namespace airlight::shadow_planes
