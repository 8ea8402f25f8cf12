// Source radiance at the nodes of a grid, on the device: single scattering, discrete ordinates or diffusion for the rest, and what of both
// goes towards the camera. A new light changes what 128 directions (of 8 levels) bring, and the columns towards those that moved.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "gpu/compensated_ray_marching/p1_grid.h"
#include "gpu/compensated_ray_marching/smoke_columns.h"
#include "gpu/timer.h"
#include "scene/renderer.h"

namespace airlight::gpu::compensated_ray_marching {

class LitGridOnDevice {
 public:
  // Uploads densities and directions. The medium and the columns outlive this. Throws Unavailable where the device has no room.
  LitGridOnDevice(Context&, const scene::Medium&, const airlight::compensated_ray_marching::Options&,
                  const airlight::compensated_ray_marching::LitGrid&, SmokeColumns&);

  // A light, or another: stages of the timer. Iterations begin with the light before, as many as it took are told to the device before
  // they are looked at.
  void light(const airlight::compensated_ray_marching::IncomingLight&, StageTimer&, const scene::Execution&);

  // Where the first light begins: with the solution of the last frame's smoke, which `solution` downloads. Diffusion begins with nothing,
  // as on the CPU, and has no solution for others.
  void begin_with(airlight::compensated_ray_marching::Solution last) { last_ = std::move(last); }
  airlight::compensated_ray_marching::Solution solution() const;

  // Logarithms of the source radiance by cell, in logarithms().
  void towards(const scene::View&, const Point3& middle);
  const Buffer& logarithms() const { return *logarithms_; }

  int iterations() const { return iterations_; }
  double error() const { return error_; }

 private:
  struct Group {  // channels that have extinction and albedo in common
    std::vector<int> channels;
    int first = 0, lights = 0;  // in buffers of all lights
    int last = 0;               // iterations
    std::unique_ptr<P1GridOnDevice> diffusion;
  };
  bool by_diffusion() const;
  Program* program_of(const char* file, int x, int y = 1);
  void upload_edges(const airlight::compensated_ray_marching::BeyondEdges&);
  void upload_ordinates();
  void upload_cells(const airlight::compensated_ray_marching::LitGrid&);
  void arrange(bool grey);
  void upload_directions(const airlight::compensated_ray_marching::IncomingLight&);
  bool begin();
  void scatter_once(const Group&);
  void scatter_again(Group&, bool cold, const scene::Execution&);
  void diffuse(Group&, const scene::Execution&);
  void iterate(const Group&, int iteration);
  void emit(const Group&);
  void sweep(const Group&);
  void collect(const Group&, int iteration);
  void decide(const Group&, int iteration);
  void combine(const Group&, int iteration);
  void set_scatterer(Program&, const Group&) const;
  Buffer& buffer(std::unique_ptr<Buffer>&, const char* name, std::size_t bytes);

  Context& context_;
  Program *single_program_ = nullptr, *emit_program_ = nullptr, *sweep_program_ = nullptr, *collect_program_ = nullptr,
          *products_program_ = nullptr, *decide_program_ = nullptr, *combine_program_ = nullptr,
          *towards_program_ = nullptr, *logarithms_program_ = nullptr, *edges_program_ = nullptr;
  const scene::Medium& medium_;
  airlight::compensated_ray_marching::Options options_;
  bool multiple_ = false, grey_ = false;
  airlight::compensated_ray_marching::NodeGrid grid_;
  airlight::compensated_ray_marching::Solution last_;
  SmokeColumns& columns_;
  int cells_ = 0, directions_ = 0, fixed_ = 0, ordinates_ = 0, lights_ = 0;
  Vec3 cells_along_;
  std::vector<double> moments_, band_moments_;
  std::vector<Group> groups_;
  std::array<int, 3> light_of_{0, 0, 0};
  int edge_count_ = 0;
  int iterations_ = 0;
  double error_ = 0;
  std::unique_ptr<Buffer> densities_, powers_, towards_light_, harmonics_, ordinate_harmonics_, weighted_, ways_, open_,
      single_, source_, result_, emitted_, radiance_of_ways_, steps_, means_, parts_, state_, radiance_, greatest_,
      logarithms_, balance_, edges_, edge_nodes_, edge_weights_;
};

}  // namespace airlight::gpu::compensated_ray_marching
