// The fast path: a tile of camera rays at once, all their steps as arrays, so that the vector kernels have enough to
// do.
//
// Scheme and steps are those of scalar.h, with float where kernels run. Stages: rays and steps (double), densities,
// transmittances; then for each light directions, occlusion, shadow columns, scattering; last the surfaces behind.
#pragma once
#include <chrono>

#include "reference/ray_marcher/plan.h"
#include "reference/ray_marcher/samples.h"
#include "reference/ray_marcher/scalar.h"

namespace airlight::ray_marcher {

// Works on one tile after another and keeps its memory; one per thread.
class TileMarcher {
 public:
  // Pixels of the rays, in their order. Rays near each other make the kernels more efficient.
  const std::vector<Pixel>& march(const Plan&, const std::vector<Ray>&, Counters&);

  // Marches at most `at_once` rays at a time. The pixels do not depend on this number.
  std::vector<Pixel> march_in_parts(const Plan&, const std::vector<Ray>&, std::size_t at_once, Counters&);

 private:
  void lay_steps();
  void place_steps();
  void divide_deep_steps();
  void sample_densities();
  void varied_densities(const Layer&, const Points&, std::size_t n);
  void weigh_steps();
  void scatter_light(int light);
  void keep_lit(int light);
  void collect();
  void shade_behind();
  void light_surfaces();
  void end_of(double Counters::*stage);
  std::size_t slot(std::size_t layer, int channel) const { return layer * channels_ + channel; }

  const Plan* plan_ = nullptr;
  const std::vector<Ray>* rays_ = nullptr;
  Counters* counters_ = nullptr;
  std::chrono::steady_clock::time_point since_;  // beginning of the stage that runs
  int channels_ = 1;                             // of the transport: 1 where every extinction is grey
  std::vector<Pixel> pixels_;
  std::vector<scene::RayEnd> ends_;
  std::vector<Pass> passes_;
  std::vector<Step> plain_steps_, divided_;
  std::size_t count_ = 0;                    // of steps
  std::vector<std::vector<float>> density_;  // [layer][step]
  StepArrays all_, steps_, lit_, less_;      // all; those that scatter; those that a light reaches
  std::vector<float> before_[3], depth_[3], weight_;
  std::vector<float> sums_[3], lit_sums_[3];  // what steps_, lit_ send to the camera
  std::vector<int> live_, index_, kept_;
  std::vector<float> local_[3], value_;
  Points points_;
  Arrivals to_, fewer_;
  Columns columns_;
  std::vector<Scatterer> scatterers_;
  std::vector<int> hit_;
  std::vector<Rgb> reflected_;
};

}  // namespace airlight::ray_marcher
