// Smoke for the experiments of this folder, and Gaussians fitted to it.
#pragma once
#include "experiments/application/probe.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments {

// The voxels of the first medium of the probe's scene that has some. Throws Error if there is none.
scene::VoxelGrid grid_of_scene(const ProbeInput&);

// A column of billowing smoke, n^3 samples of a cube of 1 m: fractal noise, displaced by a curl field. The shape does
// not depend on n. With time [s] the noise rises at 1 m/s. The finest of four octaves has 48 cells to the side.
scene::VoxelGrid noise_smoke(int n, double time = 0, int octaves = 4);

// A ball of smoke, stirred by a curl, that thins out smoothly (squared) towards its edge; n^3 samples of a cube of 1 m, an eighth filled. With
// time [s] what stirs it rises, 1 m/s.
scene::VoxelGrid puff_smoke(int n, double time = 0);

// `count` Gaussians fitted to a grid, kept in the content store that the execution carries; none for 0.
scene::GaussianSum gaussians_for(const scene::VoxelGrid&, int count, const scene::Execution&);

}  // namespace airlight::experiments
