#include "scene/load/hash_parts.h"

#include "scene/geometry/brdf_table.h"

namespace airlight::scene::load {
namespace {

void add(ContentHash&, const Unbounded&) {}

void add(ContentHash& hash, const Sphere& sphere) {
  const auto& [center, radius] = sphere;
  hash.all(center, radius);
}

void add(ContentHash& hash, const Box& box) { hash.add(box); }

void add(ContentHash& hash, const Slab& slab) {
  const auto& [normal, lo, hi] = slab;
  hash.all(normal, lo, hi);
}

void add(ContentHash& hash, const TriangleMesh& mesh) {
  const auto& [vertices, triangles, removed_degenerate] = mesh;
  hash.add(std::int64_t(vertices.size()));
  for (const Point3& vertex : vertices) hash.add(vertex);
  hash.add(std::int64_t(triangles.size()));
  for (const auto& triangle : triangles)
    for (const int index : triangle) hash.add(index);
}

void add(ContentHash& hash, const Plane& plane) {
  const auto& [point, normal] = plane;
  hash.all(point, normal);
}

void add(ContentHash& hash, const Lambert& material) {
  const auto& [albedo] = material;
  hash.add(albedo);
}

void add(ContentHash& hash, const Phong& material) {
  const auto& [diffuse, specular, exponent] = material;
  hash.all(diffuse, specular, exponent);
}

void add(ContentHash& hash, const Tabulated& material) {
  const auto& [table] = material;
  hash.all(table->thetas(), table->phis());
  for (const Rgb& value : table->values()) hash.add(value);
}

}  // namespace

void add(ContentHash& hash, const VoxelGrid& grid) {
  const auto& [size, origin_index, rotation, voxel_size, translation, clamp_border, values] = grid;
  for (int axis = 0; axis < 3; ++axis) hash.all(size[axis], origin_index[axis]);
  hash.all(rotation, voxel_size, translation, int(clamp_border), values);
}

void add(ContentHash& hash, const Region& region) {
  hash.add(int(region.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, region);
}

void add(ContentHash& hash, const Surface& surface) {
  const auto& [name, shape, material] = surface;
  hash.add(int(shape.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, shape);
  hash.add(int(material.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, material);
}

}  // namespace airlight::scene::load
