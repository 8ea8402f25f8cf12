// What a camera sees in front of or behind a medium without being part of the world: a photograph with its depth, snow flakes. Each of
// its pixels is a radiance at a depth, and ends the camera rays through it. It is not lit, casts no shadow, and nothing but the scene's
// own camera sees it (camera_end of scene.h).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace airlight::scene {

struct Scene;
struct View;

// As high as the camera's film; pixels are square, its middle column is that of the film. A film that is wider sees its outermost columns
// go on. Looked up at the nearest pixel: depths on both sides of an edge must not mix.
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

// Of a renderer that does not know them: adds the reason why not, where the scene has one.
void refuse_backdrops(const Scene&, std::vector<std::string>& reasons);

}  // namespace airlight::scene
