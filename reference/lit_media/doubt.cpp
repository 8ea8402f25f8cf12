#include "reference/lit_media/doubt.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/picture.h"

namespace airlight::lit_media {
namespace {

constexpr int rays_across = 16;
constexpr double dark = 0.05;  // what is seen through less is not looked at

// Faults of the steps of one ray: the greatest of each kind, 0 if there is none.
struct Coarse {
  double depth = 0;           // of a step
  double step = 0, lamp = 0;  // [m] a step beside a lamp, and how far the ray passes from it
  double cut = 0;             // [m] where an endless ray ends before a lamp
};

Coarse look(const LitMedia& media, const Ray& ray, const std::vector<double>& ends, double t_end, Samples& samples) {
  Coarse found;
  if (ends.size() < 2) return found;
  std::vector<double> middles(ends.size() - 1);
  for (std::size_t i = 0; i < middles.size(); ++i) middles[i] = 0.5 * (ends[i] + ends[i + 1]);
  media.extinction_along(ray, middles, samples);
  std::size_t seen = 0;  // steps before it is dark
  double depth = 0;      // of the channel that sees farthest
  for (; seen < middles.size() && std::exp(-depth) > dark; ++seen) {
    const Rgb of_step = samples.extinction[seen] * (ends[seen + 1] - ends[seen]);
    if (of_step.maxCoeff() > deepest_step) found.depth = std::max(found.depth, of_step.maxCoeff());
    depth += of_step.minCoeff();
  }
  for (const scene::Light& light : media.lights()) {
    const auto lamp = scene::ball(light);
    if (!lamp) continue;
    const Vec3 to_lamp = lamp->center - ray.origin;
    const double t = std::clamp(to_lamp.dot(ray.direction), ends.front(), ends.back());
    const double distance = (lamp->center - ray.at(t)).norm();
    const auto after = std::upper_bound(ends.begin() + 1, ends.end() - 1, t);
    const std::size_t i = std::size_t(after - ends.begin()) - 1;
    const double step = ends[i + 1] - ends[i];
    if (i < seen && (samples.extinction[i] > 0).any() && step > lamp_widths * distance && step > found.step)
      found.step = step, found.lamp = distance;
    if (ends.back() < to_lamp.norm() && media.extent(ray, {0, t_end}).hi > ends.back()) found.cut = ends.back();
  }
  return found;
}

}  // namespace

std::string doubt_of_steps(const LitMedia& media, const scene::Scene& scene, const scene::View& view,
                           const StepEnds& steps) {
  if (media.layers().empty() || !media.scatters()) return "";
  const scene::CameraRays rays(view.camera, view.width, view.height);
  const int columns = std::min(rays_across, view.width), rows = std::min(rays_across, view.height);
  int deep = 0, beside_lamps = 0, cut = 0;
  Coarse worst;
  Samples samples;
  std::vector<double> ends;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const Ray ray = rays((x + 0.5) * view.width / columns, (y + 0.5) * view.height / rows);
      const double t_end = camera_end(scene, ray).t;
      ends.clear();
      steps(ray, t_end, ends);
      const Coarse found = look(media, ray, ends, t_end, samples);
      deep += found.depth > 0;
      beside_lamps += found.step > 0;
      cut += found.cut > 0;
      worst.depth = std::max(worst.depth, found.depth);
      if (found.step > worst.step) worst.step = found.step, worst.lamp = found.lamp;
      worst.cut = std::max(worst.cut, found.cut);
    }
  const double all = double(rows) * columns;
  std::string doubt;
  const auto add = [&](int count, const std::string& text) {
    if (count <= share_of_rays * all) return;
    doubt += fmt::format("{}on {:.0f} % of rays {}", doubt.empty() ? "" : "; ", 100 * count / all, text);
  };
  add(deep, fmt::format("steps are up to {:.3g} deep, expected at most {}", worst.depth, deepest_step));
  add(beside_lamps,
      fmt::format("a lamp is nearer than half a step, up to {:.3g} m of {:.3g} m", worst.lamp, worst.step));
  add(cut, fmt::format("endless fog is cut at {:.3g} m, before a lamp", worst.cut));
  return doubt;
}

}  // namespace airlight::lit_media
