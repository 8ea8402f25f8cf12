// A picture, pixel by pixel: what a camera ray brings, the film's layers of it, and what surfaces reflect towards the viewer.
#pragma once
#include <mutex>
#include <vector>

#include "scene/camera_rays.h"
#include "scene/light/background.h"
#include "scene/renderer.h"

namespace airlight::scene {

// Result of a camera ray; radiances in [W/m^2/sr].
struct Pixel {
  Rgb airlight = Rgb::Zero();       // scattered towards the viewer by media
  Rgb surface = Rgb::Zero();        // from what ends the ray, through the media
  Rgb ambient = Rgb::Zero();        // the scene's ambient_in_scatter times 1 - transmittance
  Rgb transmittance = Rgb::Ones();  // from the viewer to what ends the ray
};

// Adds the layer `mean` to a film, and those of the parts that are kept, and fills them.
class PictureLayers {
 public:
  struct Kept {
    bool airlight = true, surface = true, ambient = false, transmittance = true;
  };
  // The film outlives this.
  PictureLayers(Film&, const Kept&);
  // From any thread, a pixel each. The mean is the sum of all parts, kept or not.
  void put(int x, int y, const Pixel&) const;

 private:
  float *mean_, *transmittance_, *airlight_, *surface_, *ambient_;  // null where left out
  std::size_t width_;
};

// parallel_for of body(i, tally), where each tally begins as Tally(). Returns their sum by +=.
template <class Tally, class Body>
Tally parallel_sum(int count, const Execution& execution, const Body& body) {
  std::mutex mutex;
  Tally total{};
  parallel_for(count, execution, [&](int i) {
    Tally tally{};
    body(i, tally);
    const std::lock_guard lock(mutex);
    total += tally;
  });
  return total;
}

// Puts pixel(ray, tally) for the ray through the centre of every pixel; the tallies as in parallel_sum.
template <class Tally, class OfRay>
Tally draw_pixels(const View& view, const Execution& execution, const PictureLayers& layers, const OfRay& pixel) {
  const CameraRays rays(view.camera, view.width, view.height);
  return parallel_sum<Tally>(view.height, execution, [&](int y, Tally& tally) {
    for (int x = 0; x < view.width; ++x) layers.put(x, y, pixel(rays(x + 0.5, y + 0.5), tally));
  });
}

// Light of one lamp that a surface reflects [W/m^2/sr], without media: 0 where the surface faces away
// from the light or is in shadow.
Rgb reflected_light(const Scene&, const Hit&, const Vec3& to_view, const Incident&);

// Light of all delta lights that a surface reflects. `transmittance_to_light(incident, l)` is the transmittance of the
// media on the way of light l.
template <class Lights, class OfLight>
Rgb direct_light(const Scene& scene, const Hit& hit, const Vec3& to_view, const Lights& lights,
                 const OfLight& transmittance_to_light) {
  Rgb sum = Rgb::Zero();
  for (std::size_t l = 0; l < lights.size(); ++l) {
    if (!is_delta(lights[l])) continue;
    const Incident in = incident(lights[l], hit.position);
    const Rgb reflected = reflected_light(scene, hit, to_view, in);
    if (!(reflected == 0).all()) sum += reflected * transmittance_to_light(in, l);
  }
  return sum;
}

// Radiance from the end of a camera ray, without media between it and the viewer: a lit surface, the background, or 0
// from a light's ball. Light that surfaces get from an environment or from each other is left out.
template <class Lights, class OfLight>
Rgb end_radiance(const Scene& scene, const Ray& ray, const RayEnd& end, const Lights& lights,
                 const OfLight& transmittance_to_light) {
  return end.hit ? direct_light(scene, *end.hit, -ray.direction, lights, transmittance_to_light)
                 : background(scene, end, ray.direction);
}

}  // namespace airlight::scene
