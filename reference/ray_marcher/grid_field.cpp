#include "reference/ray_marcher/grid_field.h"

#include <algorithm>

namespace airlight::ray_marcher {
namespace {

// Chebyshev distance in bricks to the nearest one marked 0, by two sweeps over the 26 neighbours.
void chebyshev_distance(const int n[3], std::vector<int>& distance) {
  const auto at = [&](int x, int y, int z) -> int& {
    return distance[x + std::size_t(n[0]) * (y + std::size_t(n[1]) * z)];
  };
  const auto relax = [&](int x, int y, int z, int direction) {
    int& here = at(x, y, z);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int order = dz ? dz : dy ? dy : dx;
          if (order != direction) continue;
          const int a = x + dx, b = y + dy, c = z + dz;
          if (a < 0 || b < 0 || c < 0 || a >= n[0] || b >= n[1] || c >= n[2]) continue;
          here = std::min(here, at(a, b, c) + 1);
        }
  };
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) relax(x, y, z, -1);
  for (int z = n[2]; z-- > 0;)
    for (int y = n[1]; y-- > 0;)
      for (int x = n[0]; x-- > 0;) relax(x, y, z, 1);
}

std::vector<float> free_space(const GridField& field, const std::vector<float>& values) {
  constexpr int brick = 1 << GridField::brick_shift;
  const int* n = field.bricks;
  std::vector<int> distance(std::size_t(n[0]) * n[1] * n[2], n[0] + n[1] + n[2]);
  for (int z = 0; z < field.size[2]; ++z)
    for (int y = 0; y < field.size[1]; ++y)
      for (int x = 0; x < field.size[0]; ++x) {
        if (values[x + std::size_t(field.size[0]) * (y + std::size_t(field.size[1]) * z)] == 0) continue;
        // A sample on a brick's face belongs to the cells on both sides of it.
        for (int k = std::max(0, z - 1) / brick; k <= z / brick; ++k)
          for (int j = std::max(0, y - 1) / brick; j <= y / brick; ++j)
            for (int i = std::max(0, x - 1) / brick; i <= x / brick; ++i)
              distance[i + std::size_t(n[0]) * (j + std::size_t(n[1]) * k)] = 0;
      }
  chebyshev_distance(n, distance);
  std::vector<float> free(distance.size());
  std::transform(distance.begin(), distance.end(), free.begin(),
                 [](int d) { return d == 0 ? -1.0f : float((d - 1) * brick); });
  return free;
}

std::shared_ptr<const GridSamples> make_samples(const scene::VoxelGrid& grid, const GridField& field) {
  constexpr int padding = GridField::padding;
  const std::size_t slice = std::size_t(field.size[0]) * field.size[1];
  std::vector<float> values(slice * field.size[2], 0.0f);
  float* out = values.data();
  for (int z = 0; z < field.size[2]; ++z)
    for (int y = 0; y < field.size[1]; ++y)
      for (int x = 0; x < field.size[0]; ++x, ++out) {
        const int i = x - padding, j = y - padding, k = z - padding;
        const int ci = std::clamp(i, 0, grid.size[0] - 1), cj = std::clamp(j, 0, grid.size[1] - 1),
                  ck = std::clamp(k, 0, grid.size[2] - 1);
        if (grid.clamp_border || (i == ci && j == cj && k == ck)) *out = grid.at(ci, cj, ck);
      }
  auto samples = std::make_shared<GridSamples>();
  samples->pairs.assign(2 * values.size(), 0.0f);
  for (std::size_t i = 0; i < values.size(); ++i) {
    samples->pairs[2 * i] = values[i];
    if (i >= slice) samples->pairs[2 * (i - slice) + 1] = values[i];
  }
  samples->free_distance = free_space(field, values);
  return samples;
}

}  // namespace

Point3 Frame::point(const Point3& x) const { return vector(x) + Vec3(b[0], b[1], b[2]); }

Vec3 Frame::vector(const Vec3& v) const {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

std::shared_ptr<const GridField> make_grid_field(const scene::VoxelGrid& grid, const scene::VoxelGrid* from,
                                                 const GridField* before) {
  constexpr int padding = GridField::padding;
  auto field = std::make_shared<GridField>();
  const Mat3 to_local = grid.rotation.transpose() / grid.voxel_size;
  const Vec3 shift = Vec3::Constant(padding) - grid.origin_index.cast<double>() - to_local * grid.translation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) field->frame.m[3 * i + j] = to_local(i, j);
    field->frame.b[i] = shift[i];
    field->size[i] = grid.size[i] + 2 * padding;
    field->bricks[i] = ((field->size[i] - 1) >> GridField::brick_shift) + 1;
    const float reach = grid.clamp_border ? 0.5f : 1.0f;
    field->lo[i] = padding - reach;
    field->hi[i] = padding + grid.size[i] - 1 + reach;
  }
  const bool same_values = before && from && grid.size == from->size && grid.clamp_border == from->clamp_border &&
                           grid.values == from->values;
  field->samples = same_values ? before->samples : make_samples(grid, *field);
  return field;
}

}  // namespace airlight::ray_marcher
