#include "scene/media/medium.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {
namespace {

using GridPointer = std::shared_ptr<const VoxelGrid>;

// Does the box lie wholly inside (rounding counted against it)?
bool inside(const Unbounded&, const Box&) { return true; }
bool inside(const Box& region, const Box& box) { return region.contains(box.lo) && region.contains(box.hi); }
bool inside(const Sphere& sphere, const Box& box) {
  const Vec3 far = (box.lo - sphere.center).cwiseAbs().cwiseMax((box.hi - sphere.center).cwiseAbs());
  return far.squaredNorm() * (1 + 1e-15) <= sphere.radius * sphere.radius;
}
Interval heights(const Slab& slab, const Box& box) {
  const Vec3 a = slab.normal.cwiseProduct(box.lo);
  const Vec3 b = slab.normal.cwiseProduct(box.hi);
  const double slack = 1e-15 * (a.cwiseAbs() + b.cwiseAbs()).sum();
  return {a.cwiseMin(b).sum() - slack, a.cwiseMax(b).sum() + slack};
}
bool inside(const Slab& slab, const Box& box) {
  const Interval h = heights(slab, box);
  return h.lo >= slab.lo && h.hi <= slab.hi;
}

// Does the box lie wholly outside?
bool outside(const Unbounded&, const Box&) { return false; }
bool outside(const Box& region, const Box& box) { return intersect(region, box).empty(); }
bool outside(const Sphere& sphere, const Box& box) {
  const Vec3 near = sphere.center - sphere.center.cwiseMax(box.lo).cwiseMin(box.hi);
  return near.squaredNorm() * (1 - 1e-15) > sphere.radius * sphere.radius;
}
bool outside(const Slab& slab, const Box& box) {
  const Interval h = heights(slab, box);
  return h.hi < slab.lo || h.lo > slab.hi;
}

}  // namespace

double density(const DensityField& field, const Point3& x) {
  if (const auto* grid = std::get_if<GridPointer>(&field)) return density(**grid, x);
  if (const auto* sum = std::get_if<GaussianSum>(&field)) return density(*sum, x);
  return std::get<Homogeneous>(field).density;
}

Interval density_bounds(const DensityField& field, const Box& box) {
  if (const auto* grid = std::get_if<GridPointer>(&field)) return density_bounds(**grid, box);
  if (const auto* sum = std::get_if<GaussianSum>(&field)) return density_bounds(*sum, box);
  const double value = std::get<Homogeneous>(field).density;
  return {value, value};
}

double density_integral(const DensityField& field, const Ray& ray, Interval t) {
  if (const auto* grid = std::get_if<GridPointer>(&field)) return density_integral(**grid, ray, t);
  if (const auto* sum = std::get_if<GaussianSum>(&field)) return density_integral(*sum, ray, t);
  const double value = std::get<Homogeneous>(field).density;
  return value > 0 ? value * t.length() : 0;
}

Box support(const DensityField& field) {
  if (const auto* grid = std::get_if<GridPointer>(&field)) return support(**grid);
  if (const auto* sum = std::get_if<GaussianSum>(&field); sum && sum->constant == 0) return support(*sum);
  return bounding_box(Unbounded{});
}

std::string field_name(const DensityField& field) {
  static const char* const names[] = {"homogeneous", "gaussians", "grid"};
  return names[field.index()];
}

double density(const Medium& medium, const Point3& x) {
  return contains(medium.region, x) ? density(medium.field, x) : 0;
}

Interval density_bounds(const Medium& medium, const Box& box) {
  if (box.empty() || std::visit([&](const auto& region) { return outside(region, box); }, medium.region)) return {0, 0};
  if (std::visit([&](const auto& region) { return inside(region, box); }, medium.region))
    return density_bounds(medium.field, box);
  return {0, density_bounds(medium.field, intersect(box, bounding_box(medium.region))).hi};
}

double density_integral(const Medium& medium, const Ray& ray, Interval t) {
  t = clip(medium.region, ray, t);
  return t.empty() ? 0 : density_integral(medium.field, ray, t);
}

Interval extent(const DensityField& field, const Ray& ray, Interval t) {
  if (const auto* grid = std::get_if<GridPointer>(&field)) return extent(**grid, ray, t);
  if (const auto* sum = std::get_if<GaussianSum>(&field)) return extent(*sum, ray, t);
  return t;
}

Interval extent(const Medium& medium, const Ray& ray, Interval t) {
  t = clip(medium.region, ray, t);
  if (!t.empty()) t = extent(medium.field, ray, t);
  return t.empty() ? Interval{} : t;
}

Box bounding_box(const Medium& medium) { return intersect(bounding_box(medium.region), support(medium.field)); }

Rgb extinction(const std::vector<Medium>& media, const Point3& x) {
  Rgb sum = Rgb::Zero();
  for (const Medium& medium : media) sum += medium.sigma_t * density(medium, x);
  return sum;
}

Rgb optical_depth(const std::vector<Medium>& media, const Ray& ray, Interval t) {
  Rgb sum = Rgb::Zero();
  for (const Medium& medium : media) {
    const double integral = density_integral(medium, ray, t);
    // A channel without extinction stays clear over an infinite length.
    for (int c = 0; c < 3; ++c)
      if (medium.sigma_t[c] > 0) sum[c] += medium.sigma_t[c] * integral;
  }
  return sum;
}

Rgb transmittance(const std::vector<Medium>& media, const Ray& ray, Interval t) {
  const Rgb depth = optical_depth(media, ray, t);
  return {std::exp(-depth[0]), std::exp(-depth[1]), std::exp(-depth[2])};
}

}  // namespace airlight::scene
