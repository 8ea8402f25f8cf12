#include "scene/convert/residual_bricks.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {
namespace {

using Eigen::Vector3i;

// Numbers of `cells` a brick needed for `samples`.
Vector3i bricks_along(const Vector3i& samples, int edge) {
  return (samples.array() > 0).all() ? Vector3i((samples.array() + (edge - 1)) / edge) : Vector3i(Vector3i::Zero());
}

// Calls use(x, y, z) for the whole box, x fastest.
template <class Use>
void for_each(const Vector3i& box, Use&& use) {
  for (int z = 0; z < box[2]; ++z)
    for (int y = 0; y < box[1]; ++y)
      for (int x = 0; x < box[0]; ++x) use(x, y, z);
}

// Bricks of `side` samples, `pitch` apart, the first one at `first`; empty ones are left out.
void cut(const Vector3i& size, const std::vector<std::int8_t>& levels, const Vector3i& bricks, int first, int pitch,
         int side, std::vector<std::uint32_t>& index, std::vector<std::int8_t>& values) {
  index.assign(std::size_t(bricks[0]) * bricks[1] * bricks[2], 0);
  std::vector<std::int8_t> brick(std::size_t(side) * side * side);
  std::size_t number = 0;
  for_each(bricks, [&](int bx, int by, int bz) {
    const Vector3i low = Vector3i(bx, by, bz) * pitch + Vector3i::Constant(first);
    const Vector3i from = low.cwiseMax(0), to = (low + Vector3i::Constant(side)).cwiseMin(size);
    std::fill(brick.begin(), brick.end(), std::int8_t(0));
    bool any = false;
    for (int z = from[2]; z < to[2]; ++z)
      for (int y = from[1]; y < to[1]; ++y)
        for (int x = from[0]; x < to[0]; ++x) {
          const std::int8_t level = levels[std::size_t(x) + std::size_t(size[0]) * (y + std::size_t(size[1]) * z)];
          brick[std::size_t(x - low[0]) + side * (std::size_t(y - low[1]) + side * std::size_t(z - low[2]))] = level;
          any |= level != 0;
        }
    if (any) {
      values.insert(values.end(), brick.begin(), brick.end());
      index[number] = std::uint32_t(values.size() / brick.size());
    }
    ++number;
  });
}

}  // namespace

int ResidualBricks::level(const Vector3i& sample) const {
  if ((sample.array() < 0).any() || (sample.array() >= size.array()).any()) return 0;
  const Vector3i b = sample / edge, in = sample - b * edge;
  const std::uint32_t number = index[b[0] + std::size_t(bricks[0]) * (b[1] + std::size_t(bricks[1]) * b[2])];
  if (number == 0) return 0;
  return values[((std::size_t(number - 1) * edge + in[2]) * edge + in[1]) * edge + in[0]];
}

ResidualBricks bricks_of(const Vector3i& size, const std::vector<std::int8_t>& levels, int edge) {
  ResidualBricks result;
  result.size = size;
  result.edge = edge;
  result.bricks = bricks_along(size, edge);
  cut(size, levels, result.bricks, 0, edge, edge, result.index, result.values);
  return result;
}

std::vector<std::int8_t> levels_of(const ResidualBricks& bricks) {
  std::vector<std::int8_t> levels;
  levels.reserve(std::size_t(bricks.size[0]) * bricks.size[1] * bricks.size[2]);
  for_each(bricks.size, [&](int x, int y, int z) { levels.push_back(std::int8_t(bricks.level({x, y, z}))); });
  return levels;
}

ApronBricks apron_bricks_of(const Vector3i& size, const std::vector<std::int8_t>& levels) {
  ApronBricks result;
  if (levels.empty()) return result;
  result.bricks = bricks_along(size + Vector3i::Ones(), ApronBricks::cells);
  cut(size, levels, result.bricks, -1, ApronBricks::cells, ApronBricks::side, result.index, result.values);
  return result;
}

double level_between(const ApronBricks& b, const Eigen::Vector3d& sample) {
  const Eigen::Vector3d x = sample + Eigen::Vector3d::Ones();  // from the first cell
  if (!(x.array() >= 0).all() || !(x.array() < (b.bricks * ApronBricks::cells).cast<double>().array()).all()) return 0;
  const Vector3i cell = x.cast<int>(), brick = cell / ApronBricks::cells, in = cell - brick * ApronBricks::cells;
  const std::uint32_t number =
      b.index[brick[0] + std::size_t(b.bricks[0]) * (brick[1] + std::size_t(b.bricks[1]) * brick[2])];
  if (number == 0) return 0;
  const Eigen::Vector3d f = x - cell.cast<double>();
  constexpr std::size_t side = ApronBricks::side;
  const std::int8_t* at = b.values.data() + (((number - 1) * side + in[2]) * side + in[1]) * side + in[0];
  const auto along_x = [&](std::size_t i) { return at[i] + f[0] * (at[i + 1] - at[i]); };
  const auto along_y = [&](std::size_t i) { return along_x(i) + f[1] * (along_x(i + side) - along_x(i)); };
  return along_y(0) + f[2] * (along_y(side * side) - along_y(0));
}

}  // namespace airlight::scene
