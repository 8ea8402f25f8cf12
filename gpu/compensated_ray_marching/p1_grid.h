// Multiple scattering on a grid by diffusion, on the device: the system of methods/compensated_ray_marching/p1_grid.h in double precision,
// solved by conjugate gradients on half of the cells.
#pragma once
#include <array>

#include "gpu/compensated_ray_marching/interface.h"
#include "methods/compensated_ray_marching/p1_grid.h"
#include "scene/renderer.h"

namespace airlight::gpu::compensated_ray_marching {

// What scatters, of one colour.
struct Scatterer {
  double sigma_t = 1, albedo = 0, mean_cosine = 0;
};

class P1GridOnDevice {
 public:
  // Finds the matrix. densities: of each cell, floats, which outlive this; extinction is sigma_t times density. lights: that a solve has.
  P1GridOnDevice(Context&, const airlight::compensated_ray_marching::OrdinateGrid&, const Buffer& densities,
                 const Scatterer&, int order, int lights, const airlight::compensated_ray_marching::P1Options&);

  // single: J_ss, floats [light][band][cell]; result becomes J_ss and what is scattered again. Both from light `first_light` on. Begins with
  // the solution before; as many iterations as it took are told to the device before they are looked at.
  void solve(const Buffer& single, const Buffer& result, int first_light, const scene::Execution&);

  int iterations() const { return iterations_; }  // of all lights of the last solve
  double error() const { return error_; }         // its greatest residual, relative to the right side

 private:
  void bind(Program&) const;
  void set_vectors(Program&) const;
  void gradients(int stage, int iteration);
  void iterate(const scene::Execution&);

  const Buffer& densities_;
  airlight::compensated_ray_marching::OrdinateGrid grid_;
  Scatterer scatterer_;
  airlight::compensated_ray_marching::P1Options options_;
  int cells_, lights_, groups_;
  double vacuum_ = 0;
  Program *right_program_, *gradients_program_, *radiance_program_;
  Buffer matrix_, vectors_, systems_, parts_;
  int last_ = 0, iterations_ = 0;
  double error_ = 0;
};

}  // namespace airlight::gpu::compensated_ray_marching
