#include "reference/ray_marcher/layer.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"

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
  if (const auto* box = std::get_if<Box>(&layer.medium->region)) {
    layer.shape.kind = LocalShape::box;
    for (int i = 0; i < 3; ++i) {
      layer.shape_frame.b[i] = -box->center()[i];
      layer.shape.half[i] = float(0.5 * box->size()[i]);
    }
  } else if (const auto* sphere = std::get_if<scene::Sphere>(&layer.medium->region)) {
    layer.shape.kind = LocalShape::sphere;
    for (int i = 0; i < 3; ++i) {
      layer.shape_frame.m[4 * i] = 1 / sphere->radius;
      layer.shape_frame.b[i] = -sphere->center[i] / sphere->radius;
    }
  } else if (const auto* slab = std::get_if<scene::Slab>(&layer.medium->region)) {
    layer.shape.kind = LocalShape::slab;
    for (int i = 0; i < 3; ++i) layer.shape_frame.m[i] = slab->normal[i];
    layer.shape_frame.b[0] = -0.5 * (slab->lo + slab->hi);
    layer.shape.half[0] = float(0.5 * (slab->hi - slab->lo));
  }
}

}  // namespace

bool is_visible(const scene::Medium& medium) {
  if ((medium.sigma_t <= 0).all()) return false;
  if (const auto* uniform = std::get_if<scene::Homogeneous>(&medium.field)) return uniform->density > 0;
  if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field))
    return sum->constant > 0 || !sum->gaussians.empty();
  return !support(medium.field).empty();
}

std::vector<Layer> make_layers(const std::vector<scene::Medium>& media) {
  std::vector<Layer> layers;
  for (const scene::Medium& medium : media) {
    if (!is_visible(medium)) continue;
    Layer layer{&medium, 0, true, scene::Unbounded{}, nullptr, nullptr, {}, {}, 0, 0};
    set_shape(layer);
    if (const auto* uniform = std::get_if<scene::Homogeneous>(&medium.field)) {
      layer.constant = uniform->density;
      layer.varies = false;
    } else if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field)) {
      layer.constant = sum->constant;
      layer.varies = !sum->gaussians.empty();
      if (layer.varies) {
        scene::GaussianSum varied = *sum;
        varied.constant = 0;
        const Box box = support(varied);
        layer.varied = box;
        layer.gaussians = make_gaussian_field(*sum, box);
      }
    } else {
      layer.varied = support(medium.field);
      if (const auto* grid = std::get_if<std::shared_ptr<const scene::VoxelGrid>>(&medium.field))
        layer.grid = make_grid_field(**grid);
    }
    if (layer.varies) {
      const Box box = intersect(layer.grid ? support(medium.field) : std::get<Box>(layer.varied), bounding_box(medium));
      layer.most_varied = box.empty() ? 0 : density_bounds(medium, box).hi - layer.constant;
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
