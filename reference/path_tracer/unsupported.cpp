#include "reference/path_tracer/unsupported.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/geometry/brdf_table.h"
#include "scene/math/random.h"

namespace airlight::path_tracer {
namespace {

constexpr double thickest = 1e4;
constexpr double most_work = 1e14;      // terms of densities, some 10 ns each: ten days of one processor
constexpr double most_cells = 1 << 28;  // of majorants: 1 GB

bool all_scattered(const scene::Medium& medium, int c) { return medium.sigma_t[c] > 0 && medium.albedo[c] >= 1; }

// Optical depth through the middle of the medium in its thinnest direction, of channel c.
double thinnest_depth(const scene::Medium& medium, int c) {
  const Box box = scene::bounding_box(medium);
  if (box.empty()) return 0;
  Point3 middle = Point3::Zero();
  for (int a = 0; a < 3; ++a)
    if (std::isfinite(box.lo[a]) && std::isfinite(box.hi[a])) middle[a] = box.center()[a];
  std::vector<Vec3> directions = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (const auto* slab = std::get_if<scene::Slab>(&medium.region)) {
    directions.push_back(slab->normal);
    middle += slab->normal * (0.5 * (slab->lo + slab->hi) - slab->normal.dot(middle));
  }
  double least = infinity;
  for (const Vec3& d : directions)
    least = std::min(least, scene::density_integral(medium, {middle, d}, {0, infinity}) +
                                scene::density_integral(medium, {middle, -d}, {0, infinity}));
  return least > 0 ? medium.sigma_t[c] * least : 0;
}

// Terms of density that a render sums up, to an order of magnitude: one for each Gaussian at each collision. Paths
// scatter as often as absorption lets them, and no more often than twice the depth in the thinnest direction (the mean
// chord's theorem: 4 int scattering dV / surface, which is exact for a slab).
double work(const scene::Scene& scene, const Options& options) {
  double collisions = 1, terms = 1;
  for (const scene::Medium& medium : scene.media) {
    double most = 0;
    for (int c = 0; c < 3; ++c) {
      if (!(medium.sigma_t[c] > 0)) continue;
      const double absorbed = 1 / std::max(1 - medium.albedo[c], 1e-300);
      most = std::max(most, absorbed < 10 ? absorbed : std::min(absorbed, 2 * thinnest_depth(medium, c)));
    }
    if (options.max_order >= 0) most = std::min(most, double(options.max_order));
    if (options.max_events >= 0) most = std::min(most, double(options.max_events));
    if (options.paths != Options::Paths::all) most = std::min(most, 1.0);  // they end after one scattering
    collisions += most;
    terms += scene::terms(medium.field);
  }
  return double(scene.width) * scene.height * double(options.samples) * collisions * terms;
}

// Grids of majorants whose cells the settings count; those of a voxel grid are else fewer than its voxels.
struct Majorants {
  int media = 0;
  double cells = 0;
  double terms = 0;  // each cell looks at every Gaussian
};
Majorants majorants(const scene::Scene& scene, const Options& options) {
  Majorants all;
  if (!options.supergrid) return all;
  const double cells = std::pow(options.supergrid_cells > 0 ? options.supergrid_cells : 16, 3);
  for (const scene::Medium& medium : scene.media) {
    // Grids and maps bring majorants of their own voxels and cells, unless the setting says how many.
    const bool own = scene::grid_of(medium.field) || std::holds_alternative<scene::FogmapPointer>(medium.field);
    const bool counted = !scene::homogeneous_density(medium.field) && (!own || options.supergrid_cells > 0);
    if (!counted) continue;
    ++all.media;
    all.cells += cells;
    all.terms += cells * scene::terms(medium.field);
  }
  return all;
}

bool reflects_all(const scene::Material& material, int c) {
  return scene::match(
      material, [c](const scene::Lambert& lambert) { return lambert.albedo[c] >= 1; },
      [c](const scene::Phong& phong) { return phong.diffuse[c] + phong.specular[c] >= 1; },
      [c](const scene::Tabulated& tabulated) { return tabulated.table->greatest_albedo()[c] >= 1; });
}

// Do all rays from the point end on surfaces that reflect everything in channel c?
bool enclosed(const scene::Scene& scene, const Point3& from, int c) {
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const RandomBlock block{philox4x32_10({i, 0, 0, 0}, {0, 0})};
    const double z = 2 * block.fine(0) - 1, angle = 2 * pi * block.fine(1), r = std::sqrt(1 - z * z);
    const auto hit = scene.geometry->first_hit({from, Vec3(r * std::cos(angle), r * std::sin(angle), z)});
    if (!hit || !reflects_all(scene.surfaces[hit->surface].material, c)) return false;
  }
  return true;
}

bool white_room_with_light(const scene::Scene& scene) {
  if (!scene.geometry) return false;
  for (int c = 0; c < 3; ++c) {
    bool absorbs = false;
    for (const scene::Medium& medium : scene.media)
      absorbs = absorbs || (medium.sigma_t[c] > 0 && medium.albedo[c] < 1);
    if (absorbs) continue;
    bool shines = false;
    for (const scene::Light& light : scene.lights)
      if (const auto ball = scene::ball(light)) shines = shines || enclosed(scene, ball->center, c);
    if (shines && enclosed(scene, scene.camera.position, c)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons;
  const bool all_paths = !options.only_lit_surfaces();  // else they end after one scattering
  if (options.max_events >= 0 && !all_paths)
    reasons.push_back("max_events caps all paths, found paths of a lit surface alone, which have two events at most");
  if (options.max_order < 0 && options.max_events < 0 && all_paths)
    for (std::size_t i = 0; i < scene.media.size(); ++i) {
      const scene::Medium& medium = scene.media[i];
      double depth = 0;
      for (int c = 0; c < 3; ++c)
        if (all_scattered(medium, c)) depth = std::max(depth, thinnest_depth(medium, c));
      if (depth > thickest)
        reasons.push_back(fmt::format(
            "{} scatters everything (albedo 1) and is {:.3g} optical depths thick, expected at most {:.3g}, "
            "an albedo below 1, or a cap (max_order)",
            scene::label(scene.media, i), depth, thickest));
    }
  for (const scene::Light& light : scene.lights) {
    const auto ball = scene::ball(light);
    if (!ball || ball->radius > 0 || scene.camera.kind != scene::Camera::Kind::perspective) continue;
    if (ball->center == scene.camera.position && (scene::extinction(scene.media, ball->center) > 0).any())
      reasons.push_back(fmt::format(
          "the {} light stands on the camera, in a medium: every pixel is infinite; expected a distance or a radius",
          scene::light_name(light)));
  }
  if (all_paths && white_room_with_light(scene))
    reasons.push_back(
        "the camera is in a closed room that reflects everything (albedo 1) with a light in it: there is no finite "
        "answer; expected an albedo below 1 or an opening");
  if (reasons.empty())
    if (const double needed = work(scene, options); needed > most_work)
      reasons.push_back(
          fmt::format("{} x {} pixels, {} samples of each and this medium need {:.1g} evaluations of terms of its "
                      "density, expected at most {:.0e}: fewer samples, pixels or Gaussians, or a cap (max_order)",
                      scene.width, scene.height, options.samples, needed, most_work));
  const Majorants grids = majorants(scene, options);
  if (grids.cells > most_cells)
    reasons.push_back(fmt::format(
        "supergrid_cells = {} takes {:.1f} GB of majorants for {} media, expected at most {:.1f}: fewer "
        "supergrid_cells",
        options.supergrid_cells, grids.cells * sizeof(float) / 1e9, grids.media, most_cells * sizeof(float) / 1e9));
  else if (grids.terms > most_work)
    reasons.push_back(
        fmt::format("supergrid_cells = {}: majorants of {:.1g} cells need {:.1g} evaluations of terms of densities, "
                    "expected at most {:.0e}: fewer supergrid_cells or Gaussians",
                    options.supergrid_cells, grids.cells, grids.terms, most_work));
  if (!options.column_transmittance)
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      if (scene.media[i].sigma_t.minCoeff() != scene.media[i].sigma_t.maxCoeff())
        reasons.push_back(
            fmt::format("{} has coloured extinction, which transmittance=ratio cannot weight; "
                        "expected transmittance=column",
                        scene::label(scene.media, i)));
  return reasons;
}

}  // namespace airlight::path_tracer
