#include "scene/load/hash_parts.h"

#include "scene/geometry/brdf_table.h"

namespace airlight::scene::load {
namespace {

void add(ContentHash&, const Unbounded&) {}

void add(ContentHash& hash, const Sphere& sphere) {
  hash.add(sphere.center);
  hash.add(sphere.radius);
}

void add(ContentHash& hash, const Box& box) { hash.add(box); }

void add(ContentHash& hash, const Slab& slab) {
  hash.add(slab.normal);
  hash.add(slab.lo);
  hash.add(slab.hi);
}

void add(ContentHash& hash, const TriangleMesh& mesh) {
  hash.add(std::int64_t(mesh.vertices.size()));
  for (const Point3& vertex : mesh.vertices) hash.add(vertex);
  hash.add(std::int64_t(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles)
    for (const int index : triangle) hash.add(index);
}

void add(ContentHash& hash, const Plane& plane) {
  hash.add(plane.point);
  hash.add(plane.normal);
}

void add(ContentHash& hash, const Lambert& material) { hash.add(material.albedo); }

void add(ContentHash& hash, const Phong& material) {
  hash.add(material.diffuse);
  hash.add(material.specular);
  hash.add(material.exponent);
}

void add(ContentHash& hash, const Tabulated& material) {
  const BrdfTable& table = *material.table;
  hash.add(table.thetas());
  hash.add(table.phis());
  for (const Rgb& value : table.values()) hash.add(value);
}

}  // namespace

void add(ContentHash& hash, const VoxelGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    hash.add(grid.size[axis]);
    hash.add(grid.origin_index[axis]);
  }
  hash.add(grid.rotation);
  hash.add(grid.voxel_size);
  hash.add(grid.translation);
  hash.add(int(grid.clamp_border));
  hash.add(grid.values);
}

void add(ContentHash& hash, const Region& region) {
  hash.add(int(region.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, region);
}

void add(ContentHash& hash, const Surface& surface) {
  hash.add(int(surface.shape.index()));
  std::visit([&](const auto& shape) { add(hash, shape); }, surface.shape);
  hash.add(int(surface.material.index()));
  std::visit([&](const auto& material) { add(hash, material); }, surface.material);
}

}  // namespace airlight::scene::load
