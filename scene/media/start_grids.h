// Grids for the start of a flow, from OpenVDB files of any program: signed, and with directions.
#pragma once
#include <array>
#include <string>

#include "scene/media/voxel_grid.h"

namespace airlight::scene {

inline constexpr double greatest_start = 1e6;  // of a component of a velocity [m/s], of a temperature [K]

// The three components, each at its own samples: on the low faces of the file's voxels where its grid is staggered,
// else all in the middle of voxels. Values of either sign.
using VelocityGrid = std::array<VoxelGrid, 3>;

// Reads a temperature grid like read_vdb, but values can have either sign; their size is at most greatest_start.
VoxelGrid read_temperature_vdb(const std::string& path, const std::string& name, std::size_t max_voxels = 1u << 30);
// Reads a grid of three floats per voxel, not rotated. Throws Error like read_vdb. From a frame
// (write_frame) only the faces are read.
VelocityGrid read_velocity_vdb(const std::string& path, const std::string& name, std::size_t max_voxels = 1u << 28);

// Trilinear between samples; at one, to 1e-6 of a voxel, its bits. The nearest up to half a voxel around them, 0
// beyond.
double start_value(const VoxelGrid&, const Point3& x);

}  // namespace airlight::scene
