// Levels of a residual in cubes of samples ("bricks"), of which only those are kept that hold a level other than 0, and an index that says
// where each is: one look-up after another, no search. In place of the hash of Zhou et al. 2008; as NanoVDB's leaves.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace airlight::scene {

struct ResidualBricks {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();    // samples
  int edge = 8;                                      // samples along a side of a brick
  Eigen::Vector3i bricks = Eigen::Vector3i::Zero();  // along the axes: size / edge, rounded up
  std::vector<std::uint32_t> index;                  // a brick's number + 1, 0 where it is empty; x fastest
  std::vector<std::int8_t> values;                   // edge^3 a brick, x fastest; 0 beyond the size

  std::size_t kept() const { return values.size() / (std::size_t(edge) * edge * edge); }
  // Size on a device: the index of 4 bytes, and the values.
  std::size_t bytes() const { return 4 * index.size() + values.size(); }
  // 0 outside.
  int level(const Eigen::Vector3i& sample) const;
};

// `levels`: size.prod() of them, x fastest. Edge 1 to 64.
ResidualBricks bricks_of(const Eigen::Vector3i& size, const std::vector<std::int8_t>& levels, int edge = 8);
std::vector<std::int8_t> levels_of(const ResidualBricks&);

// Bricks for interpolation between samples that looks into one brick only: a brick is of 8^3 cells, so that it has 9 samples along a side,
// those of its far faces a second time (the apron). The cells begin one before the first sample: beyond the border the residual falls to 0
// as a VoxelGrid does.
struct ApronBricks {
  static constexpr int cells = 8, side = cells + 1;
  Eigen::Vector3i bricks = Eigen::Vector3i::Zero();  // along the axes: (size + 1) / 8, rounded up
  std::vector<std::uint32_t> index;                  // as above
  std::vector<std::int8_t> values;                   // side^3 a brick
  std::size_t kept() const { return values.size() / (side * side * side); }
  std::size_t bytes() const { return 4 * index.size() + values.size(); }
};
ApronBricks apron_bricks_of(const Eigen::Vector3i& size, const std::vector<std::int8_t>& levels);
// Trilinear between the levels at a position in samples, 0 beyond their support (one voxel outside) [levels].
double level_between(const ApronBricks&, const Eigen::Vector3d& sample);

}  // namespace airlight::scene
