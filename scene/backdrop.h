// Pictures that a camera sees in front of or behind a medium, without being part of the world: a photograph with its
// depth, snow flakes. Each pixel is a radiance at a depth, and ends the camera rays through it. A backdrop is not lit,
// casts no shadow, and only the scene's own camera sees it (camera_end of scene.h).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace airlight::scene {

struct Scene;
struct View;

// A picture with depth, as high as the camera's film. Pixels are square; the middle column is the middle of the film. A
// film that is wider than the picture sees the outermost columns repeated. Lookups take the nearest pixel, because
// depths on both sides of an edge must not mix.
struct Backdrop {
  int width = 0, height = 0;
  std::vector<float> radiance;  // linear RGB [W/m^2/sr], x fastest, row 0 the top
  std::vector<float> depth;     // [m] along the axis of view, > 0; infinity where there is no end
  bool fills = true;            // what has no end is seen, in place of environments; false: nothing is there
};

struct SeenPoint {
  double t;  // [m] along the ray
  Rgb radiance;
};
// Where a ray of this camera meets the backdrop; nothing where it shows nothing.
std::optional<SeenPoint> seen_along(const Backdrop&, const Camera&, const Ray&);

// Throws Error unless the view is through the scene's own camera, or the scene has no backdrop.
void require_own_camera(const Scene&, const View&);

// For renderers without support for backdrops: adds the reason, if the scene has a backdrop.
void refuse_backdrops(const Scene&, std::vector<std::string>& reasons);

}  // namespace airlight::scene
