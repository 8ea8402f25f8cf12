#include "scene/media/medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {
namespace {

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

GaussianSum moved_by(GaussianSum sum, const Vec3& by) {
  for (Gaussian& g : sum.gaussians) g.center += by;
  return sum;
}

VoxelGrid moved_by(VoxelGrid grid, const Vec3& by) {
  grid.translation += by;
  return grid;
}

double greatest(const VoxelGrid& grid) {
  return grid.values.empty() ? 0 : *std::max_element(grid.values.begin(), grid.values.end());
}

}  // namespace

double density(const DensityField& field, const Point3& x) {
  return match(
      field, [](const Homogeneous& uniform) { return uniform.density; },
      [&](const GaussianSum& sum) { return density(sum, x); },
      [&](const GridPointer& grid) { return density(*grid, x); },
      [&](const FogmapPointer& fog) { return density(*fog, x); },
      [&](const LegendrePointer& box) { return density(*box, x); },
      [&](const FittedPointer& fitted) { return density(fitted->grid, x); });
}

Interval density_bounds(const DensityField& field, const Box& box) {
  return match(
      field,
      [](const Homogeneous& uniform) {
        return Interval{uniform.density, uniform.density};
      },
      [&](const GaussianSum& sum) { return density_bounds(sum, box); },
      [&](const GridPointer& grid) { return density_bounds(*grid, box); },
      [&](const FogmapPointer& fog) { return density_bounds(*fog, box); },
      [&](const LegendrePointer& series) { return density_bounds(*series, box); },
      [&](const FittedPointer& fitted) { return density_bounds(fitted->grid, box); });
}

double density_integral(const DensityField& field, const Ray& ray, Interval t) {
  return match(
      field, [&](const Homogeneous& uniform) { return uniform.density > 0 ? uniform.density * t.length() : 0; },
      [&](const GaussianSum& sum) { return density_integral(sum, ray, t); },
      [&](const GridPointer& grid) { return density_integral(*grid, ray, t); },
      [&](const FogmapPointer& fog) { return density_integral(*fog, ray, t); },
      [&](const LegendrePointer& box) { return density_integral(*box, ray, t); },
      [&](const FittedPointer& fitted) { return density_integral(fitted->grid, ray, t); });
}

Interval extent(const DensityField& field, const Ray& ray, Interval t) {
  return match(
      field, [&](const Homogeneous&) { return t; }, [&](const GaussianSum& sum) { return extent(sum, ray, t); },
      [&](const GridPointer& grid) { return extent(*grid, ray, t); },
      [&](const FogmapPointer& fog) { return extent(*fog, ray, t); },
      [&](const LegendrePointer& box) { return extent(*box, ray, t); },
      [&](const FittedPointer& fitted) { return extent(fitted->grid, ray, t); });
}

Box support(const DensityField& field) {
  const bool everywhere = homogeneous_density(field) || constant_part(field) != 0;
  return everywhere ? bounding_box(Unbounded{}) : varied_support(field);
}

double constant_part(const DensityField& field) {
  return match(
      field, [](const Homogeneous& uniform) { return uniform.density; },
      [](const GaussianSum& sum) { return sum.constant; }, [](const GridPointer&) { return 0.0; },
      [](const FogmapPointer&) { return 0.0; }, [](const LegendrePointer&) { return 0.0; },
      [](const FittedPointer&) { return 0.0; });
}

Box varied_support(const DensityField& field) {
  return match(
      field, [](const Homogeneous&) { return Box{}; }, [](const GaussianSum& sum) { return support(sum); },
      [](const GridPointer& grid) { return support(*grid); }, [](const FogmapPointer& fog) { return support(*fog); },
      [](const LegendrePointer& box) { return support(*box); },
      [](const FittedPointer& fitted) { return support(fitted->grid); });
}

std::optional<double> homogeneous_density(const DensityField& field) {
  using Density = std::optional<double>;
  return match(
      field, [](const Homogeneous& uniform) -> Density { return uniform.density; },
      [](const GaussianSum&) -> Density { return std::nullopt; },
      [](const GridPointer&) -> Density { return std::nullopt; },
      [](const FogmapPointer&) -> Density { return std::nullopt; },
      [](const LegendrePointer&) -> Density { return std::nullopt; },
      [](const FittedPointer&) -> Density { return std::nullopt; });
}

double greatest_density(const DensityField& field) {
  return match(
      field, [](const Homogeneous& uniform) { return uniform.density; },
      [](const GaussianSum& sum) {
        double most = sum.constant;
        for (const Gaussian& g : sum.gaussians) most = std::max(most, std::abs(g.amplitude));
        return most;
      },
      [](const GridPointer& grid) { return greatest(*grid); },
      [](const FogmapPointer& fog) { return density_bounds(*fog, bounding_box(Unbounded{})).hi; },
      [](const LegendrePointer& box) { return box->greatest(); },
      [](const FittedPointer& fitted) { return greatest(fitted->grid); });
}

std::string field_name(const DensityField& field) {
  return match(
      field, [](const Homogeneous&) { return "homogeneous"; }, [](const GaussianSum&) { return "gaussians"; },
      [](const GridPointer&) { return "grid"; }, [](const FogmapPointer&) { return "fogmap"; },
      [](const LegendrePointer&) { return "legendre"; }, [](const FittedPointer&) { return "fitted"; });
}

double detail(const DensityField& field) {
  return match(
      field, [](const Homogeneous&) { return infinity; }, [](const GaussianSum&) { return infinity; },
      [](const GridPointer& grid) { return grid->voxel_size; }, [](const FogmapPointer& fog) { return fog->cell; },
      [](const LegendrePointer& series) {
        const auto& n = series->shape();
        return series->box().size().cwiseQuotient(Vec3(n[0], n[1], n[2])).minCoeff();
      },
      [](const FittedPointer& fitted) { return fitted->grid.voxel_size; });
}

double terms(const DensityField& field) {
  return match(
      field, [](const Homogeneous&) { return 0.0; },
      [](const GaussianSum& sum) { return double(sum.gaussians.size()); }, [](const GridPointer&) { return 0.0; },
      [](const FogmapPointer&) { return 0.0; },
      [](const LegendrePointer& series) { return double(series->coefficients().size()) / 8; },
      [](const FittedPointer&) { return 0.0; });
}

DensityField moved(const DensityField& field, const Vec3& by) {
  return match(
      field, [](const Homogeneous& uniform) -> DensityField { return uniform; },
      [&](const GaussianSum& sum) -> DensityField { return moved_by(sum, by); },
      [&](const GridPointer& grid) -> DensityField { return std::make_shared<const VoxelGrid>(moved_by(*grid, by)); },
      [&](const FogmapPointer& fog) -> DensityField {
        auto moved = std::make_shared<Fogmap>(*fog);
        moved->x0 += by[0], moved->z0 += by[2];
        return FogmapPointer(std::move(moved));
      },
      [&](const LegendrePointer& series) -> DensityField {
        const Box& at = series->box();
        return std::make_shared<const LegendreBox>(Box{at.lo + by, at.hi + by}, series->shape(),
                                                   series->coefficients());
      },
      [&](const FittedPointer& fitted) -> DensityField {
        Fitted moved = *fitted;
        moved.gaussians = moved_by(moved.gaussians, by);
        moved.grid = moved_by(moved.grid, by);
        return std::make_shared<const Fitted>(std::move(moved));
      });
}

const VoxelGrid* grid_of(const DensityField& field) {
  using Grid = const VoxelGrid*;
  return match(
      field, [](const Homogeneous&) -> Grid { return nullptr; }, [](const GaussianSum&) -> Grid { return nullptr; },
      [](const GridPointer& grid) -> Grid { return grid.get(); }, [](const FogmapPointer&) -> Grid { return nullptr; },
      [](const LegendrePointer&) -> Grid { return nullptr; },
      [](const FittedPointer& fitted) -> Grid { return &fitted->grid; });
}

bool extinguishes(const Medium& medium) {
  if (!(medium.sigma_t > 0).any()) return false;
  return match(
      medium.field, [](const Homogeneous& uniform) { return uniform.density > 0; },
      [](const GaussianSum& sum) { return sum.constant > 0 || !sum.gaussians.empty(); },
      [](const GridPointer& grid) { return !support(*grid).empty(); },
      [](const FogmapPointer& fog) { return !support(*fog).empty(); },
      [](const LegendrePointer& box) { return box->greatest() > 0; },
      [](const FittedPointer& fitted) { return !support(fitted->grid).empty(); });
}

std::string label(const std::vector<Medium>& media, std::size_t i) {
  return media[i].name.empty() ? fmt::format("medium {}", i) : fmt::format("medium '{}'", media[i].name);
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
