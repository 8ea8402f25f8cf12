#include "reference/half_resolution_march/passes.h"

#include "reference/half_resolution_march/filter.h"
#include "reference/half_resolution_march/history.h"
#include "reference/half_resolution_march/jitter.h"
#include "reference/lit_media/doubt.h"
#include "scene/base/flush_subnormals.h"

namespace airlight::half_resolution_march {
namespace {

// A marched ray and where it ends: the depth of a block [m] along the camera's axis.
struct BlockRay {
  Ray ray;
  double depth = infinity;
  double t_end(const scene::Camera& camera) const {
    return depth == infinity ? infinity : depth / ray.direction.dot(camera.forward);
  }
};

// The ray of block (x, y). Even blocks of the checkerboard take their nearest pixel, odd ones their farthest; where all are equally
// far, and with depth = centre, the ray goes through the middle.
BlockRay block_ray(const Plan& plan, const scene::View& view, const scene::CameraRays& rays, const LowFilm& film,
                   const Behind& behind, int x, int y) {
  BlockRay middle{rays(film.across.center(x), film.down.center(y))};
  if (behind.depth.empty()) return middle;
  if (!plan.options.min_max) {
    const double t = camera_end(*plan.scene, middle.ray).t;
    return {middle.ray, t == infinity ? infinity : t * middle.ray.direction.dot(view.camera.forward)};
  }
  int least[2] = {film.across.begin(x), film.down.begin(y)}, most[2] = {least[0], least[1]};
  const auto depth = [&](int i, int j) { return behind.depth[std::size_t(j) * view.width + i]; };
  for (int j = film.down.begin(y); j < film.down.end(y); ++j)
    for (int i = film.across.begin(x); i < film.across.end(x); ++i) {
      if (depth(i, j) < depth(least[0], least[1]) * (1 - same_depth)) least[0] = i, least[1] = j;
      if (depth(i, j) > depth(most[0], most[1]) * (1 + same_depth)) most[0] = i, most[1] = j;
    }
  const double near = depth(least[0], least[1]), far = depth(most[0], most[1]);
  if (depth_difference(near, far) <= same_depth * near) return {middle.ray, near};
  const int* pixel = (x + y) % 2 == 0 ? least : most;
  return {rays(pixel[0] + 0.5, pixel[1] + 0.5), depth(pixel[0], pixel[1])};
}

FogPixel packed(const Rgb& airlight, const Rgb& transmittance) {
  FogPixel fog = FogPixel::Zero();
  fog.head<3>() = airlight.cast<float>();
  fog.segment<3>(3) = transmittance.cast<float>();
  return fog;
}

}  // namespace

bool ends_rays(const scene::Scene& scene) {
  if (scene.geometry || !scene.backdrops.empty()) return true;
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
    const auto ball = scene::ball(light);
    return ball && ball->radius > 0;
  });
}

bool seen_behind(const scene::Scene& scene) {
  return scene.geometry || !scene.backdrops.empty() || has_environment(scene);
}

double bytes_needed(const Plan& plan, const scene::View& view) {
  const LowFilm one(1, 1, 1);
  const double pixels = double(view.width) * view.height, divide = plan.options.divide;
  const double blocks = std::ceil(view.width / divide) * std::ceil(view.height / divide);
  return pixels * ((ends_rays(*plan.scene) ? sizeof(double) : 0) + (seen_behind(*plan.scene) ? sizeof(Rgb) : 0)) +
         blocks * ((plan.options.blur ? 2 : 1) * sizeof(FogPixel) + sizeof(double)) +
         (plan.options.reproject ? blocks * (3 * sizeof(FogPixel) + 2 * sizeof(double) + sizeof(Trace)) : 0);
}

Behind look_behind(const Plan& plan, const scene::View& view, const scene::Execution& execution, Counters& counters) {
  const scene::Scene& scene = *plan.scene;
  Behind behind;
  const std::size_t pixels = std::size_t(view.width) * view.height;
  if (ends_rays(scene)) behind.depth.resize(pixels);
  if (seen_behind(scene)) behind.radiance.resize(pixels);
  const scene::CameraRays rays(view.camera, view.width, view.height);
  const bool maps = plan.media->map_bytes() > 0;
  counters += scene::parallel_sum<Counters>(view.height, execution, [&](int y, Counters& of_row) {
    const scene::FlushSubnormals flush;
    for (int x = 0; x < view.width; ++x) {
      const Ray ray = rays(x + 0.5, y + 0.5);
      const scene::RayEnd end = camera_end(scene, ray);
      const std::size_t at = std::size_t(y) * view.width + x;
      if (!behind.depth.empty())
        behind.depth[at] = end.t == infinity ? infinity : end.t * ray.direction.dot(view.camera.forward);
      if (behind.radiance.empty()) continue;
      behind.radiance[at] =
          scene::end_radiance(scene, ray, end, plan.media->lights(), [&](const scene::Incident&, std::size_t light) {
            of_row.media.look_ups += maps;
            return plan.media->transmittance_to_light(light, end.hit->position);
          });
    }
    of_row.pixels += view.width;
  });
  return behind;
}

Marched march_blocks(const Plan& plan, const scene::View& view, const Behind& behind, int first,
                     const scene::View* last, const scene::Execution& execution, Counters& counters) {
  const Options& options = plan.options;
  Marched marched{LowFilm(view.width, view.height, options.divide), {}};
  LowFilm& film = marched.film;
  if (last) marched.traces.resize(film.fog.size());
  if (!behind.depth.empty()) film.depth.resize(film.fog.size());
  const scene::CameraRays rays(view.camera, view.width, view.height);
  counters += scene::parallel_sum<Counters>(film.height(), execution, [&](int y, Counters& of_row) {
    const scene::FlushSubnormals flush;
    static thread_local Steps steps;
    for (int x = 0; x < film.width(); ++x) {
      const BlockRay block = block_ray(plan, view, rays, film, behind, x, y);
      const Stretch stretch = marched_stretch(*plan.media, block.ray, block.t_end(view.camera), options.from_camera);
      of_row.longest = std::max(of_row.longest, stretch.in_media);
      Rgb airlight = Rgb::Zero(), transmittance = Rgb::Zero();
      double distance = 0;
      for (int frame = 0; frame < options.frames; ++frame) {
        const Fog fog = march(*plan.media, options, block.ray, stretch,
                              step_offset(options.jitter, x, y, first + frame), steps, of_row.media);
        airlight += fog.airlight;
        transmittance += fog.transmittance;
        distance = options.airlight_depth ? fog.distance : stretch.t.hi;
      }
      film.fog[film.at(x, y)] = packed(airlight / options.frames, transmittance / options.frames);
      if (!film.depth.empty()) film.depth[film.at(x, y)] = block.depth;
      if (last && !stretch.t.empty())
        marched.traces[film.at(x, y)] =
            trace_of(film, x, y, block.ray, distance, block.t_end(view.camera), view, *last);
    }
    of_row.rays += film.width() * options.frames;
  });
  return marched;
}

std::string doubt_of(const lit_media::LitMedia& media, const Options& options, const scene::Scene& scene,
                     const scene::View& view) {
  return lit_media::doubt_of_steps(media, scene, view, [&](const Ray& ray, double t_end, std::vector<double>& ends) {
    const Interval t = marched_stretch(media, ray, t_end, options.from_camera).t;
    if (t.empty()) return;
    for (int i = 0; i <= options.steps; ++i) ends.push_back(t.lo + i * (t.length() / options.steps));
  });
}

void compose(const Plan& plan, const scene::View& view, const LowFilm& film, double edge, const Behind& behind,
             const scene::PictureLayers& layers, const scene::Execution& execution) {
  std::vector<Neighbours> across;
  for (int x = 0; x < view.width; ++x) across.push_back(neighbours(film.across, x));
  scene::parallel_for(view.height, execution, [&](int y) {
    const scene::FlushSubnormals flush;
    const Neighbours down = neighbours(film.down, y);
    for (int x = 0; x < view.width; ++x) {
      const std::size_t at = std::size_t(y) * view.width + x;
      const FogPixel fog =
          upsampled(film, across[std::size_t(x)], down, behind.depth.empty() ? infinity : behind.depth[at],
                    plan.options.nearest_depth, edge);
      scene::Pixel pixel;
      pixel.airlight = fog.head<3>().cast<double>();
      pixel.transmittance = fog.segment<3>(3).cast<double>();
      if (!behind.radiance.empty()) pixel.surface = pixel.transmittance * behind.radiance[at];
      layers.put(x, y, pixel);
    }
  });
}

}  // namespace airlight::half_resolution_march
