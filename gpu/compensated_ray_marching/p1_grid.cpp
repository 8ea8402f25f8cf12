#include "gpu/compensated_ray_marching/p1_grid.h"

#include <algorithm>
#include <cmath>

#include "gpu/compensated_ray_marching/diffusion_vectors.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::OrdinateGrid;
using airlight::compensated_ray_marching::P1Options;
using diffusion::SystemData;

constexpr int p1_line = 64, p1_lanes = 128;  // invocations of a work group; of one that sums
constexpr int sums = 5;                      // p1_sums.glsl
constexpr int groups_on_software = 16;       // of sums; a work group there takes long to meet at a barrier
constexpr int p1_first_iterations = 16;      // told to the device before any is looked at

enum P1MatrixStage { p1_stage_faces, p1_stage_inverse };  // p1_matrix.comp
// p1_gradients.comp
enum P1GradientStage {
  p1_stage_eliminated,
  p1_stage_begin,
  p1_stage_turn,
  p1_stage_half,
  p1_stage_along,
  p1_stage_step
};

Program& p1_program(Context& context, const char* file, int x, int order = 1) {
  return program(context, file, x, 1,
                 {{"BANDS", std::to_string(order * order)},
                  {"VECTORS", std::to_string(diffusion::vectors_of_gradients)},
                  {"SUMS", std::to_string(sums)},
                  {"STAGE_FACES", std::to_string(p1_stage_faces)},
                  {"STAGE_ELIMINATED", std::to_string(p1_stage_eliminated)},
                  {"STAGE_BEGIN", std::to_string(p1_stage_begin)},
                  {"STAGE_TURN", std::to_string(p1_stage_turn)},
                  {"STAGE_HALF", std::to_string(p1_stage_half)},
                  {"STAGE_ALONG", std::to_string(p1_stage_along)}});
}

std::size_t bytes(int cells, int numbers) { return 8 * std::size_t(cells) * std::size_t(numbers); }

}  // namespace

P1GridOnDevice::P1GridOnDevice(Context& context, const OrdinateGrid& grid, const Buffer& densities,
                               const Scatterer& scatterer, int order, int lights, const P1Options& options)
    : densities_(densities),
      grid_(grid),
      scatterer_(scatterer),
      options_(options),
      cells_(int(grid.nodes())),
      lights_(lights),
      groups_(std::clamp(cells_ / (2 * p1_lanes), 1, context.software() ? groups_on_software : p1_lanes)),
      vacuum_(airlight::compensated_ray_marching::extinction_of_vacuum(grid)),
      right_program_(&p1_program(context, "p1_right", p1_lanes, order)),
      gradients_program_(&p1_program(context, "p1_gradients", p1_lanes)),
      radiance_program_(&p1_program(context, "p1_radiance", p1_line, order)),
      matrix_(context, "diffusion matrix", bytes(cells_, 5), Contents::undefined),
      vectors_(context, "vectors of diffusion", bytes(cells_, diffusion::vectors_of_gradients * lights)),
      systems_(context, "diffusion systems", sizeof(SystemData) * std::size_t(lights)),
      parts_(context, "parts of sums", bytes(groups_, sums * lights)) {
  Program& p = p1_program(context, "p1_matrix", p1_line);
  bind(p);
  matrix_.bind(at::matrix);
  for (const int stage : {p1_stage_faces, p1_stage_inverse}) {
    p.set("stage", stage);
    p.dispatch(cells_);
  }
}

void P1GridOnDevice::bind(Program& p) const {
  densities_.bind(at::densities);
  p.set("cells_along", Vec3(grid_.size[0], grid_.size[1], grid_.size[2]));
  p.set("with_ends", Vec3(!grid_.endless[0], !grid_.endless[1], !grid_.endless[2]));
  p.set_double("cell_edges", grid_.cell);
  p.set_double("sigma_t", scatterer_.sigma_t);
  p.set_double("albedo", scatterer_.albedo);
  p.set_double("transport", 3 * (1 - scatterer_.albedo * scatterer_.mean_cosine));
  p.set_double("vacuum", vacuum_);
}

void P1GridOnDevice::set_vectors(Program& p) const {
  vectors_.bind(at::vectors);
  systems_.bind(at::systems);
  p.set("unknowns", cells_);
  p.set("first_system", 0);
}

void P1GridOnDevice::gradients(int stage, int iteration) {
  Program& p = *gradients_program_;
  p.set("stage", stage);
  p.set("iteration", iteration);
  p.dispatch(groups_ * p1_lanes, 1, lights_);
}

void P1GridOnDevice::solve(const Buffer& single, const Buffer& result, int first_light,
                           const scene::Execution& execution) {
  parts_.bind(at::parts);
  single.bind(at::single);
  Program& right = *right_program_;
  bind(right);
  set_vectors(right);
  right.set("first_light", first_light);
  right.set("groups", groups_);
  right.dispatch(groups_ * p1_lanes, 1, lights_);

  iterate(execution);

  Program& radiance = *radiance_program_;
  bind(radiance);
  set_vectors(radiance);
  result.bind(at::result);
  radiance.set("first_light", first_light);
  radiance.set_double("mean_cosine", scatterer_.mean_cosine);
  radiance.dispatch(cells_, 1, lights_);
}

void P1GridOnDevice::iterate(const scene::Execution& execution) {
  Program& p = *gradients_program_;
  bind(p);
  set_vectors(p);
  matrix_.bind(at::matrix);
  p.set("groups", groups_);
  p.set("most_iterations", options_.iterations);
  p.set_double("tolerance", options_.tolerance);
  gradients(p1_stage_eliminated, 1);
  gradients(p1_stage_begin, 1);
  gradients(p1_stage_turn, 1);
  int told = 0, next = std::min(last_ > 0 ? last_ : p1_first_iterations, options_.iterations);
  for (bool done = false; !done;) {
    for (; told < next; ++told) {
      gradients(p1_stage_half, told + 1);
      gradients(p1_stage_along, told + 1);
      gradients(p1_stage_step, told + 1);
      gradients(p1_stage_turn, told + 2);
    }
    iterations_ = last_ = 0;
    error_ = 0;
    done = true;
    for (const SystemData& system : systems_.download<SystemData>()) {
      done = done && system.done != 0;
      iterations_ += system.iterations;
      last_ = std::max(last_, system.iterations);
      if (system.whole > 0) error_ = std::max(error_, std::sqrt(system.square) / system.whole);
    }
    if (done) break;
    if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
    next = std::min(told + std::max(4, told / 2), options_.iterations);
  }
  gradients(p1_stage_eliminated, 1);
}

}  // namespace airlight::gpu::compensated_ray_marching
