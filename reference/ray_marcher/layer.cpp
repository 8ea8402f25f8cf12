#include "reference/ray_marcher/layer.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/same_medium.h"

namespace airlight::ray_marcher {

namespace {

std::shared_ptr<const GaussianField> make_gaussian_field(const scene::GaussianSum& sum, const Box& box) {
  auto field = std::make_shared<GaussianField>();
  const Point3 center = box.center();
  for (int i = 0; i < 3; ++i) {
    field->frame.b[i] = -center[i];
    field->lo[i] = float(box.lo[i] - center[i]);
    field->hi[i] = float(box.hi[i] - center[i]);
  }
  field->constant = float(sum.constant);
  for (const scene::Gaussian& g : sum.gaussians) {
    const Point3 local = g.center - center;
    field->x.push_back(float(local[0]));
    field->y.push_back(float(local[1]));
    field->z.push_back(float(local[2]));
    field->inverse_width.push_back(float(1 / g.width));
    field->amplitude.push_back(float(g.amplitude));
    field->reach.push_back(float(g.width * std::min(sum.cutoff, std::sqrt(32.0))));  // exp(-32) = 1e-14
    field->any_negative = field->any_negative || g.amplitude < 0;
  }
  field->count = sum.gaussians.size();
  return field;
}

// A region in a frame of its own, around its middle, where float has digits to spare.
void set_shape(Layer& layer) {
  scene::match(
      layer.medium->region, [](const scene::Unbounded&) {},
      [&](const Box& box) {
        layer.shape.kind = LocalShape::box;
        for (int i = 0; i < 3; ++i) {
          layer.shape_frame.b[i] = -box.center()[i];
          layer.shape.half[i] = float(0.5 * box.size()[i]);
        }
      },
      [&](const scene::Sphere& sphere) {
        layer.shape.kind = LocalShape::sphere;
        for (int i = 0; i < 3; ++i) {
          layer.shape_frame.m[4 * i] = 1 / sphere.radius;
          layer.shape_frame.b[i] = -sphere.center[i] / sphere.radius;
        }
      },
      [&](const scene::Slab& slab) {
        layer.shape.kind = LocalShape::slab;
        for (int i = 0; i < 3; ++i) layer.shape_frame.m[i] = slab.normal[i];
        layer.shape_frame.b[0] = -0.5 * (slab.lo + slab.hi);
        layer.shape.half[0] = float(0.5 * (slab.hi - slab.lo));
      });
}

void set_grid(Layer& layer, const scene::VoxelGrid& grid, const Layer* before) {
  layer.varies = true;
  layer.grid = make_grid_field(grid, before ? scene::grid_of(before->medium->field) : nullptr,
                               before ? before->grid.get() : nullptr);
}

// Sets the varying part, and its kernel.
void set_varied(Layer& layer, const Layer* before) {
  const Box box = varied_support(layer.medium->field);
  scene::match(
      layer.medium->field, [&](const scene::Homogeneous&) { layer.varies = false; },
      [&](const scene::GaussianSum& sum) {
        layer.varies = !sum.gaussians.empty();
        if (layer.varies) layer.gaussians = make_gaussian_field(sum, box);
      },
      [&](const scene::GridPointer& grid) { set_grid(layer, *grid, before); },
      [&](const scene::FogmapPointer&) { layer.varies = true; },
      [&](const scene::LegendrePointer&) { layer.varies = true; },
      [&](const scene::FittedPointer& fitted) { set_grid(layer, fitted->grid, before); });
  if (!layer.varies) return;
  layer.varied = box;
  const Box inside = intersect(box, bounding_box(*layer.medium));
  layer.most_varied = inside.empty() ? 0 : density_bounds(*layer.medium, inside).hi - layer.constant;
}

}  // namespace

std::vector<Layer> make_layers(const std::vector<scene::Medium>& media, const std::vector<Layer>& all_before) {
  std::vector<Layer> layers;
  for (const scene::Medium& medium : media) {
    if (!extinguishes(medium)) continue;
    const Layer* before = layers.size() < all_before.size() ? &all_before[layers.size()] : nullptr;
    const bool same = before && same_medium(*before->medium, medium);
    Layer layer = same ? *before : Layer{};
    layer.medium = &medium;
    if (!same) {
      layer.constant = constant_part(medium.field);
      set_shape(layer);
      set_varied(layer, before);
    }
    layers.push_back(std::move(layer));
  }
  double thickest = 0;
  for (const Layer& layer : layers)
    if (layer.varies) thickest += layer.medium->sigma_t.maxCoeff();
  for (Layer& layer : layers) layer.thickest = thickest;
  return layers;
}

Interval constant_extent(const Layer& layer, const Ray& ray, Interval t) {
  if (layer.constant == 0) return {};
  return clip(layer.medium->region, ray, t);
}

Interval varied_extent(const Layer& layer, const Ray& ray, Interval t) {
  if (!layer.varies) return {};
  const Interval inside = clip(layer.medium->region, ray, t);
  if (inside.empty() || !layer.grid) return inside.empty() ? inside : clip(layer.varied, ray, inside);
  // A grid may be rotated: its box is straight in its own frame.
  const GridField& grid = *layer.grid;
  const Box box{Point3(grid.lo[0], grid.lo[1], grid.lo[2]), Point3(grid.hi[0], grid.hi[1], grid.hi[2])};
  return scene::clip(box, {grid.frame.point(ray.origin), grid.frame.vector(ray.direction)}, inside);
}

double varied_density(const Layer& layer, const Point3& x) { return density(layer.medium->field, x) - layer.constant; }

int steps_through(Interval extent, int count, double length) {
  if (length <= 0) return count;
  // The cap keeps a tiny step in a huge medium from running for ever.
  return int(std::clamp(std::ceil(extent.length() / length), 1.0, double(1 << 20)));
}

double marched_column(const Layer& layer, const Options& options, const Ray& ray, Interval t, long long& steps) {
  const Interval whole = constant_extent(layer, ray, t);
  double column = whole.empty() ? 0 : layer.constant * whole.length();
  const Interval extent = varied_extent(layer, ray, t);
  if (extent.empty()) return column;
  const int n = steps_through(extent, options.shadow_steps, options.shadow_step);
  const double h = extent.length() / n, extinction = layer.thickest;
  if (starts_deep(options, layer.most_varied * extinction, h) &&
      starts_deep(options, varied_density(layer, ray.at(extent.lo)) * extinction, h))
    return column + deep_column(layer, options, ray, extent, n, steps);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += varied_density(layer, ray.at(extent.lo + (i + 0.5) * h));
  steps += n;
  return column + h * sum;
}

}  // namespace airlight::ray_marcher
