// Multiple scattering at the centres of the Gaussians, on the device: the diffusion system of methods/compensated_ray_marching, its matrix in
// full, solved by least squares in double precision.
#pragma once
#include <memory>
#include <vector>

#include "gpu/compensated_ray_marching/centre_tables.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/renderer.h"

namespace airlight::gpu::compensated_ray_marching {

class CentreDiffusion {
 public:
  // Finds the matrices. Buffers: centres; what they scatter once, in bands, which is read; what they scatter again, which is written. They,
  // the Gaussians and the medium outlive this.
  CentreDiffusion(Context&, const CentreTables&, const Buffer& centres, const Buffer& single, const Buffer& again,
                  const std::vector<scene::Gaussian>&, const scene::Medium&,
                  const airlight::compensated_ray_marching::Options&);

  // Does no channel scatter?
  bool empty() const { return groups_.empty(); }
  // Begins with the radiance before; as many iterations as it took are told to the device before they are looked at. `grey`: all channels
  // have the same light.
  void scatter_again(bool grey, const scene::Execution&);

  // Where the first light begins: with the solution of the last frame's smoke, which `solution` downloads.
  void begin_with(const airlight::compensated_ray_marching::Solution&);
  airlight::compensated_ray_marching::Solution solution() const;

  int iterations() const { return iterations_; }             // of all channels
  double residual() const { return residual_; }              // the greatest, relative
  double negative_share() const { return negative_share_; }  // of the centres' scattered radiance, taken as 0

 private:
  struct Group {  // channels of one extinction and albedo, which have their matrix in common
    std::vector<int> channels;
    int first = 0;    // of its systems, one a channel
    int systems = 1;  // that are solved: one while all lights were without colour
    int last = 0;     // iterations
    std::unique_ptr<Buffer> matrix, row_scales;
  };
  void find_groups();
  void scatter_again(Group&, const scene::Execution&);
  void solve(Group&, const scene::Execution&);
  void product(const Group&, bool transposed, int from, int to);
  void gradients(const Group&, int stage);
  void bind_systems(Program&, const Group&) const;
  void bind_channels(Program&, const Group&) const;

  Context& context_;
  const Buffer &centres_, &single_, &again_;
  const std::vector<scene::Gaussian>& gaussians_;
  const scene::Medium& medium_;
  airlight::compensated_ray_marching::Options options_;
  int count_ = 0;
  std::vector<Group> groups_;
  int iterations_ = 0;
  double residual_ = 0, negative_share_ = 0;
  Program *matrix_program_ = nullptr, *right_program_ = nullptr, *again_program_ = nullptr, *product_program_ = nullptr,
          *transposed_program_ = nullptr, *gradients_program_ = nullptr;
  std::unique_ptr<Buffer> vectors_, systems_;
};

}  // namespace airlight::gpu::compensated_ray_marching
