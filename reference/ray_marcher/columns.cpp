#include <algorithm>

#include "reference/ray_marcher/depth.h"
#include "reference/ray_marcher/samples.h"

namespace airlight::ray_marcher {
namespace {

// Stands for an endless column: any extinction makes it black, and zero extinction times it is zero.
constexpr float endless = 1e30f;

}  // namespace

void Columns::march(const Plan& plan, std::size_t light, std::size_t n, const Points& points, const Arrivals& to,
                    Counters& counters) {
  columns_.resize(plan.layers.size());
  for (auto* v : {&ox_, &oy_, &oz_, &dx_, &dy_, &dz_, &t0_, &t1_}) resize_padded(*v, n);
  const LocalRays rays{ox_.data(), oy_.data(), oz_.data(), dx_.data(), dy_.data(), dz_.data(), t0_.data(), t1_.data()};
  const auto enter = [&](const Frame& frame) {
    to_local(frame, n, points.x.data(), points.y.data(), points.z.data(), ox_.data(), oy_.data(), oz_.data());
    rotate_to_local(frame, n, to.to_x.data(), to.to_y.data(), to.to_z.data(), dx_.data(), dy_.data(), dz_.data());
  };
  const StepRule rule{plan.options.shadow_steps, float(plan.options.shadow_step)};
  const bool exact = plan.options.shadow == Shadow::exact;
  mapped_ = !plan.maps.empty();
  (mapped_ ? counters.look_ups : counters.shadow_rays) += n;
  if (mapped_) look_up(*plan.maps[light], n, points);
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    const Layer& layer = plan.layers[k];
    std::vector<float>& column = columns_[k];
    column.assign(padded(n), 0.0f);
    const bool kernel = mapped_ || !layer.varies || (layer.grid && !exact) ||
                        (layer.gaussians && !(exact && layer.gaussians->any_negative));
    if (mapped_ && layer.constant == 0) continue;
    if (!kernel) {
      for (std::size_t i = 0; i < n; ++i) {
        const Ray ray{points.at(i), Vec3(to.to_x[i], to.to_y[i], to.to_z[i]).normalized()};
        const Interval t{0, to.distance[i]};
        const double value = exact ? density_integral(*layer.medium, ray, t)
                                   : marched_column(layer, plan.options, ray, t, counters.shadow_steps);
        column[i] = float(std::min(value, double(endless)));
      }
      continue;
    }
    std::fill(t0_.begin(), t0_.end(), 0.0f);
    std::copy(to.distance.begin(), to.distance.begin() + n, t1_.begin());
    if (layer.shape.kind != LocalShape::everything) {
      enter(layer.shape_frame);
      clip_rays(layer.shape, n, rays);
    }
    if (layer.constant > 0)
      for (std::size_t i = 0; i < n; ++i)
        column[i] = std::min(float(layer.constant) * std::max(0.0f, t1_[i] - t0_[i]), endless);
    if (mapped_) continue;
    if (layer.grid) {
      enter(layer.grid->frame);
      clip_rays(layer.grid->lo, layer.grid->hi, n, rays);
      march_deep(plan, layer, n, points, to, column, counters);
      counters.shadow_steps += grid_columns(*layer.grid, rule, plan.options.skip_empty, n, rays, column.data());
    } else if (layer.gaussians) {
      enter(layer.gaussians->frame);
      clip_rays(layer.gaussians->lo, layer.gaussians->hi, n, rays);
      if (exact) {
        gaussian_integrals(*layer.gaussians, n, rays, column.data());
        continue;
      }
      march_deep(plan, layer, n, points, to, column, counters);
      counters.shadow_steps += gaussian_columns(*layer.gaussians, rule, n, rays, column.data());
    }
  }
}

void Columns::look_up(const light_map::LightMap& map, std::size_t n, const Points& points) {
  float* depths[3];
  for (int c = 0; c < map.channels(); ++c) {
    resize_padded(depth_[c], n);
    depths[c] = depth_[c].data();
  }
  map.varied_depths(n, points.x.data(), points.y.data(), points.z.data(), depths);
  for (int c = 0; c < 3; ++c) depths_[c] = depth_[c < map.channels() ? c : 0].data();
}

// Adds the columns of those rays whose first step is deep, one by one in double, and leaves nothing of them to the
// kernel.
void Columns::march_deep(const Plan& plan, const Layer& layer, std::size_t n, const Points& points, const Arrivals& to,
                         std::vector<float>& column, Counters& counters) {
  const Options& options = plan.options;
  const double extinction = layer.thickest;
  for (std::size_t i = 0; i < n; ++i) {
    const Interval t{t0_[i], t1_[i]};
    if (t.empty()) continue;
    const int count = steps_through(t, options.shadow_steps, options.shadow_step);
    const double h = t.length() / count;
    if (!starts_deep(options, layer.most_varied * extinction, h)) continue;
    const Ray ray{points.at(i), Vec3(to.to_x[i], to.to_y[i], to.to_z[i]).normalized()};
    if (!starts_deep(options, varied_density(layer, ray.at(t.lo)) * extinction, h)) continue;
    column[i] =
        float(std::min(column[i] + deep_column(layer, options, ray, t, count, counters.shadow_steps), double(endless)));
    t1_[i] = t0_[i];
  }
}

}  // namespace airlight::ray_marcher
