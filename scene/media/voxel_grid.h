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
  // World = rotation * (scale * index) + translation, with uniform scale; checked at load.
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

// Trilinear density at a world point [-].
double density(const VoxelGrid&, const Point3& x);

// Least and greatest density over a world box: over all samples that touch it, background included; rigorous.
Interval density_bounds(const VoxelGrid&, const Box&);

// Integral of the density over t in [t0, t1] of the ray [m]: two-point Gauss in every voxel crossed, exact for the
// cubic that a trilinear density is along a line. Cost: one step per voxel crossed.
double density_integral(const VoxelGrid&, const Ray&, Interval t);

// World box outside which the density is zero; empty for an empty grid.
Box support(const VoxelGrid&);

// Reads grid `name` of an OpenVDB file. Throws Error (file, grid, what was found, what was expected) if it is missing,
// not a float grid, not uniformly scaled, truncated or damaged, holds NaN, infinity (with the index) or a negative
// value, or has more than max_voxels samples in its active bounding box.
VoxelGrid read_vdb(const std::string& path, const std::string& name = "density", std::size_t max_voxels = 1u << 30);

// Writes the samples as a float fog volume called `name`, atomically; zero samples stay inactive.
void write_vdb(const std::string& path, const VoxelGrid&, const std::string& name = "density");

}  // namespace airlight::scene
