#include "scene/load/ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/load/table_reader.h"
#include "scene/media/fogmap.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene::load {
namespace {

bool near(const Point3& x) { return (x.array().abs() <= greatest_length).all(); }

}  // namespace

void require_extinction(const TableReader& reader, const Medium& medium) {
  const double density = greatest_density(medium.field);
  for (int c = 0; c < 3; ++c)
    if (!extinction_range.contains(medium.sigma_t[c] * density))
      reader.fail(reader.has("sigma_t") ? "sigma_t" : "",
                  fmt::format("sigma_t times the greatest density = {:.6g} * {:.6g}, expected {} 1/m",
                              medium.sigma_t[c], density, extinction_range.words()));
}

void require_resolved(const TableReader& reader, const Scene& scene, const Medium& medium) {
  const double extinction = medium.sigma_t.maxCoeff() * greatest_density(medium.field);
  double reach = scene.camera.position.cwiseAbs().maxCoeff();
  const Box box = bounding_box(medium);
  if (box.empty()) return;
  for (const Point3& corner : {box.lo, box.hi})
    for (int axis = 0; axis < 3; ++axis)
      if (std::isfinite(corner[axis])) reach = std::max(reach, std::abs(corner[axis]));
  if (extinction * reach > greatest_depth)
    reader.fail("", fmt::format("its greatest extinction is {:.6g} 1/m, {:.6g} m from the origin: mean free paths "
                                "drown in the rounding of places, expected a product of at most {:.6g}",
                                extinction, reach, greatest_depth));
}

void require_radiance(const TableReader& reader, const EnvironmentLight& light) {
  if (!light.map || light.map->rgb.empty()) return;
  const double texel = *std::max_element(light.map->rgb.begin(), light.map->rgb.end());
  const double most = light.scale.maxCoeff() * texel;
  if (most > amount.greatest)
    reader.fail("file", fmt::format("scale times the brightest texel = {:.6g} * {:.6g}, expected at most {:.6g}",
                                    light.scale.maxCoeff(), texel, amount.greatest));
}

void require_near(const TableReader& reader, const std::string& key, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (const Point3& x = mesh.vertices[i]; !near(x))
      reader.fail(key, fmt::format("vertex {} comes to lie at [{:.6g}, {:.6g}, {:.6g}] m, expected coordinates in "
                                   "[{:.6g}, {:.6g}]",
                                   i, x[0], x[1], x[2], -greatest_length, greatest_length));
}

void require_near(const TableReader& reader, const std::string& key, const VoxelGrid& grid) {
  if (!length.contains(grid.voxel_size))
    reader.fail(key, fmt::format("voxels come to be {:.6g} m apart, expected {}", grid.voxel_size, length.words()));
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index = grid.origin_index.cast<double>();
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) index[axis] += grid.size[axis];
    const Point3 x = grid.rotation * (grid.voxel_size * index) + grid.translation;
    if (!near(x))
      reader.fail(key, fmt::format("a corner of the grid comes to lie at [{:.6g}, {:.6g}, {:.6g}] m, expected "
                                   "coordinates in [{:.6g}, {:.6g}]",
                                   x[0], x[1], x[2], -greatest_length, greatest_length));
  }
}

void require_near(const TableReader& reader, const std::string& key, const Fogmap& fog) {
  if (!length.contains(fog.cell))
    reader.fail(key, fmt::format("cells come to be {:.6g} m wide, expected {}", fog.cell, length.words()));
  for (const auto& [x, z] : ground_corners(fog))
    if (!near({x, 0, z}))
      reader.fail(key,
                  fmt::format("a corner of the map comes to lie at x = {:.6g}, z = {:.6g} m, expected coordinates in "
                              "[{:.6g}, {:.6g}]",
                              x, z, -greatest_length, greatest_length));
}

}  // namespace airlight::scene::load
