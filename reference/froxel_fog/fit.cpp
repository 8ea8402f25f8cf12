#include "reference/froxel_fog/fit.h"

#include <algorithm>

#include "scene/picture.h"

namespace airlight::froxel_fog {
namespace {

constexpr double most_far = 1e150;  // [m]: squares of places remain numbers

struct Union {
  Interval all;
  void operator+=(const Interval& part) {
    if (!part.empty()) all = {std::min(all.lo, part.lo), std::max(all.hi, part.hi)};
  }
  void operator+=(const Union& other) { *this += other.all; }
};

// The visible range of the media on a ray up to its end: a colour channel ends in a constant medium, or where the media
// end that extinguish it.
Interval seen(const std::vector<ray_marcher::Layer>& layers, const Ray& ray, double end) {
  Union of_channel[3], all;
  Rgb dark = Rgb::Constant(most_far);
  for (const ray_marcher::Layer& layer : layers) {
    const Interval constant = constant_extent(layer, ray, {0, end}), varied = varied_extent(layer, ray, {0, end});
    for (int c = 0; c < 3; ++c) {
      const double sigma_t = layer.medium->sigma_t[c];
      if (!(sigma_t > 0)) continue;
      of_channel[c] += constant;
      of_channel[c] += varied;
      if (!constant.empty()) dark[c] = std::min(dark[c], constant.lo + fitted_depth / (sigma_t * layer.constant));
    }
  }
  for (int c = 0; c < 3; ++c) all += intersect(of_channel[c].all, {0, dark[c]});
  return all.all;
}

}  // namespace

double depth_per_metre(const scene::Camera& camera, const Ray& ray) {
  return camera.kind == scene::Camera::Kind::orthographic ? 1 : ray.direction.dot(camera.forward);
}

Interval media_depths(const lit_media::Plan& plan, const scene::View& view, const scene::Execution& execution) {
  if (plan.layers.empty()) return {};
  const scene::CameraRays rays(view.camera, view.width, view.height);
  return scene::parallel_sum<Union>(view.height, execution,
                                    [&](int y, Union& row) {
                                      for (int x = 0; x < view.width; ++x) {
                                        const Ray ray = rays(x + 0.5, y + 0.5);
                                        const Interval t = seen(plan.layers, ray, camera_end(*plan.scene, ray).t);
                                        const double along = depth_per_metre(view.camera, ray);
                                        if (!t.empty()) row += Interval{t.lo * along, t.hi * along};
                                      }
                                    })
      .all;
}

Interval slice_range(const Options& o, Interval media) {
  if (o.far > 0) return {o.near, o.far};
  return media.empty() ? media : Interval{o.near > 0 ? o.near : media.lo, media.hi};
}

}  // namespace airlight::froxel_fog
