// Density on a regular grid, trilinear between samples.
//
// Sample (i, j, k) sits at the integer index point origin_index + (i, j, k) of the grid's transform, as in OpenVDB.
// Outside the samples the background is zero, so that the support reaches one voxel beyond them; with clamp_border the
// nearest sample is continued over half a voxel instead and the support ends there.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

struct VoxelGrid {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();          // samples per axis; all >= 1, or all 0 for an empty grid
  Eigen::Vector3i origin_index = Eigen::Vector3i::Zero();  // index of sample (0, 0, 0)
  // World = rotation * (voxel_size * index) + translation; `rotation` is orthogonal (a mirroring one will do).
  Mat3 rotation = Mat3::Identity();
  double voxel_size = 1;  // [m], > 0
  Vec3 translation = Vec3::Zero();
  bool clamp_border = false;
  std::vector<float> values;  // x fastest: values[i + size.x * (j + size.y * k)]; finite, >= 0

  float at(int i, int j, int k) const { return values[i + std::size_t(size[0]) * (j + std::size_t(size[1]) * k)]; }
};

// Continuous position in samples: integer coordinates are the samples, (0,0,0) the first one. And back.
Point3 world_to_sample(const VoxelGrid&, const Point3& world);
Point3 sample_to_world(const VoxelGrid&, const Point3& sample);

// The ray in samples; its parameter stays in metres, so that the direction has another length.
Ray ray_in_samples(const VoxelGrid&, const Ray&);
// The support in samples; empty for an empty grid.
Box sample_support(const VoxelGrid&);

// Trilinear density at a world point, and at a position in samples [-].
double density(const VoxelGrid&, const Point3& x);
double density_at_sample(const VoxelGrid&, const Point3& sample);

// Least and greatest density over a world box; rigorous, and exact to rounding where the grid is not rotated against
// it.
Interval density_bounds(const VoxelGrid&, const Box&);
// Least and greatest density over a box in samples, always exact to rounding.
Interval density_bounds_at_samples(const VoxelGrid&, const Box& samples);

// Integral of the density over t in [t0, t1] of the ray [m]: two-point Gauss in every voxel crossed, exact for the
// cubic that a trilinear density is along a line. Cost: one step per voxel crossed.
double density_integral(const VoxelGrid&, const Ray&, Interval t);

// The part of t outside which the density is zero; empty if nowhere.
Interval extent(const VoxelGrid&, const Ray&, Interval t);

// World box outside which the density is zero; empty for an empty grid.
Box support(const VoxelGrid&);

// Reads grid `name` of an OpenVDB file: the box of its active voxels, or that which write_vdb noted. Throws Error
// (file, grid, what was found, what was expected) if it is missing, not a float grid with background 0, not uniformly
// scaled to 1e-6, truncated or damaged, holds NaN, infinity or a negative value (with the index), or spans more than
// max_voxels. Every length in the file is checked before OpenVDB reads it. Changed bytes within compressed samples can
// only be noticed by a checksum: write_vdb stores one in the file, and if there is a file PATH.xxh128 (the output of
// `xxh128sum PATH`) it must match.
VoxelGrid read_vdb(const std::string& path, const std::string& name = "density", std::size_t max_voxels = 1u << 30);

// Writes the samples as a float fog volume called `name`, atomically; zero samples stay inactive. read_vdb reads it
// back bit for bit (the rotation up to rounding), unless it must refuse the grid. Throws Error.
void write_vdb(const std::string& path, const VoxelGrid&, const std::string& name = "density");

}  // namespace airlight::scene
