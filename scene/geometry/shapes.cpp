#include "scene/geometry/shapes.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"

namespace airlight::scene {

TriangleMesh make_box(const Box& box) {
  const Vec3 size = box.size();
  if (!size.allFinite() || !(size.minCoeff() > 0))
    throw Error(fmt::format("box of {} x {} x {} m, expected finite sides above 0", size[0], size[1], size[2]));
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)  // bit 0: x, bit 1: y, bit 2: z
    mesh.vertices.emplace_back((corner & 1 ? box.hi : box.lo)[0], (corner & 2 ? box.hi : box.lo)[1],
                               (corner & 4 ? box.hi : box.lo)[2]);
  for (const std::array<int, 4>& q : {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
                                      std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

TriangleMesh make_height_field(const HeightField& field) {
  if (field.nx < 2 || field.nz < 2 || field.heights.size() != std::size_t(field.nx) * std::size_t(field.nz))
    throw Error(
        fmt::format("height field of {} x {} vertices with {} heights, expected at least 2 x 2 and as many heights",
                    field.nx, field.nz, field.heights.size()));
  if (!field.origin.allFinite() || !(field.spacing_x > 0) || !(field.spacing_z > 0) ||
      !std::isfinite(field.spacing_x) || !std::isfinite(field.spacing_z))
    throw Error(fmt::format("height field with spacing {} x {} m, expected finite values above 0", field.spacing_x,
                            field.spacing_z));
  TriangleMesh mesh;
  for (int k = 0; k < field.nz; ++k)
    for (int i = 0; i < field.nx; ++i) {
      const double height = field.heights[i + std::size_t(field.nx) * k];
      if (!std::isfinite(height))
        throw Error(fmt::format("height ({}, {}) is {}, expected a finite value", i, k, height));
      mesh.vertices.push_back(field.origin + Vec3(i * field.spacing_x, height, k * field.spacing_z));
    }
  for (int k = 0; k + 1 < field.nz; ++k)
    for (int i = 0; i + 1 < field.nx; ++i) {
      const int a = i + field.nx * k, b = a + 1, c = a + field.nx, d = c + 1;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  return mesh;
}

}  // namespace airlight::scene
