#include "scene/renderer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

#include "scene/base/device_check.h"
#include "scene/base/threads.h"

namespace airlight::scene {

void Renderer::require_support(const Scene& scene, const Settings& settings) const {
  const std::vector<std::string> reasons = supports(scene, settings);
  if (!reasons.empty())
    throw NotSupported(fmt::format("{}: {} cannot render this: {}", scene.name, name(), reasons.front()),
                       reasons.front());
}

std::unique_ptr<Prepared> Renderer::prepare(std::shared_ptr<const Scene> scene, const Settings& settings,
                                            const Execution& execution) const {
  require_support(*scene, settings);
  check_device(*this);
  return prepare_supported(std::move(scene), settings, execution);
}

void parallel_for(int rows, const Execution& execution, const std::function<void(int)>& body) {
  std::atomic<int> done{0};
  std::atomic<bool> stopped{false};
  tbb::task_arena arena(threads_for(execution.threads));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, rows, 1),
        [&](const tbb::blocked_range<int>& range) {
          for (int row = range.begin(); row < range.end() && !stopped; ++row) {
            body(row);
            const int now = ++done;
            if (execution.progress && !execution.progress(double(now) / rows)) stopped = true;
          }
        },
        tbb::simple_partitioner());
  });
  if (stopped) throw Interrupted("interrupted");
}

std::vector<unsigned char> ball_mask(const Scene& scene, const View& view) {
  std::vector<unsigned char> mask(std::size_t(view.width) * view.height, 0);
  for (const Light& light : scene.lights) {
    const auto sphere = ball(light);
    if (!sphere || sphere->radius <= 0) continue;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        // A pixel touches the ball if its centre ray passes within the radius widened by half the pixel's diagonal
        // there.
        const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
        const Ray corner = camera_ray(view.camera, x, y, view.width, view.height);
        const double along = (sphere->center - ray.origin).dot(ray.direction);
        if (along < -sphere->radius) continue;
        const double widening = (corner.at(std::max(along, 0.0)) - ray.at(std::max(along, 0.0))).norm();
        if ((ray.at(std::max(along, 0.0)) - sphere->center).norm() <= sphere->radius + widening)
          mask[std::size_t(y) * view.width + x] = 1;
      }
  }
  return mask;
}

}  // namespace airlight::scene
