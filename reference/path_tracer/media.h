// The media of a scene, made ready for tracking: each with its supergrid, tracked on its own.
//
// Several media at one point superpose: independent collision distances are drawn in each and the nearest one wins,
// which draws the medium in proportion to its extinction there and needs no common majorant.
#pragma once
#include <optional>
#include <vector>

#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/options.h"
#include "reference/path_tracer/supergrid.h"
#include "scene/math/random.h"
#include "scene/media/medium.h"
#include "scene/media/voxel_grid.h"

namespace airlight::path_tracer {

struct TrackedMedium {
  const scene::Medium* medium = nullptr;
  bool homogeneous = false;                // constant density in its region: exact free flights, no majorant
  double constant = 0;                     // that density
  const scene::VoxelGrid* grid = nullptr;  // of a voxel grid: its rays, lookups and majorants are in samples
  Supergrid majorants;                     // of the density
  // For a sum of Gaussians: a sum for each cell of `majorants`, without the Gaussians that are below the rounding of the
  // density in that cell. The list is empty for other media, and where every Gaussian counts in every cell.
  std::vector<scene::GaussianSum> of_cell;

  // The ray as lookups and majorants take it; its parameter stays in metres.
  Ray tracking_ray(const Ray& ray) const { return grid ? scene::ray_in_samples(*grid, ray) : ray; }
  double density_at(const Point3& tracking_point) const {
    if (grid) return scene::density_at_sample(*grid, tracking_point);
    const std::ptrdiff_t cell = of_cell.empty() ? -1 : majorants.cell_at(tracking_point);
    return cell >= 0 ? scene::density(of_cell[std::size_t(cell)], tracking_point)
                     : scene::density(medium->field, tracking_point);
  }
};

struct Collision {
  double t;    // along the ray [m]
  int medium;  // index into the tracked media
  double density;
};

constexpr std::size_t most_media = 64;
constexpr int most_attempts = 128;  // of a flight

class Media {
 public:
  Media(const std::vector<scene::Medium>&, const Options&);

  const std::vector<TrackedMedium>& tracked() const { return tracked_; }
  bool empty() const { return tracked_.empty(); }
  bool homogeneous() const { return homogeneous_; }  // all of them: flights cost next to nothing
  bool grey() const { return grey_; }                // extinction is the same in all channels, in every medium

  // The first collision before tmax under the extinction of channel `hero`, by delta tracking (delta_tracking.cpp);
  // nothing if there is none. Other attempts, below `most_attempts`, are independent flights. `some` < 1: given that there is a collision,
  // null ones counted, which has this probability.
  std::optional<Collision> fly(const Ray&, double tmax, int hero, const SampleRandom&, std::uint32_t vertex,
                               int attempt, double any_tentative, Counters&) const;
  // Mean number of collisions on [0, tmax], null ones counted, for each channel's extinction.
  Rgb majorant_depth(const Ray&, double tmax) const;
  // The part of [0, tmax] from the first to the last point where any medium is met.
  Interval hull(const Ray&, double tmax) const;
  // Optical depth and transmittance over [0, tmax], per channel, by noise-free columns.
  Rgb optical_depth(const Ray&, double tmax, Counters&) const;
  Rgb transmittance(const Rgb& optical_depth) const;
  Rgb transmittance(const Ray& ray, double tmax, Counters& counters) const {
    return transmittance(optical_depth(ray, tmax, counters));
  }
  // Transmittance by ratio tracking: unbiased, noisy; only where grey().
  Rgb ratio_transmittance(const Ray&, double tmax, const SampleRandom&, std::uint32_t vertex, std::uint32_t branch,
                          Counters&) const;

 private:
  std::vector<TrackedMedium> tracked_;
  bool grey_ = true, homogeneous_ = true;
};

}  // namespace airlight::path_tracer
