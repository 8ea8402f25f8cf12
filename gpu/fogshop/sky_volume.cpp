#include "gpu/fogshop/sky_volume.h"

#include <algorithm>
#include <optional>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/interface.h"

namespace airlight::gpu::fogshop {
namespace {

// Pairs of beam and Gaussian in one dispatch, all nodes together: a fraction of a second on a GPU.
constexpr double most_pairs = 2e9;

// The layout of sky_volume.comp.
struct BeamData {
  std::array<float, 3> direction;
  float unused;
  std::array<float, 3> weight;
  float unused_too;
};

std::vector<BeamData> beam_data(const std::vector<airlight::fogshop::SkyBeam>& beams) {
  std::vector<BeamData> data;
  for (const auto& [w, weight] : beams)
    data.push_back(
        {{float(w[0]), float(w[1]), float(w[2])}, 0, {float(weight[0]), float(weight[1]), float(weight[2])}, 0});
  return data;
}

double node_count(const airlight::fogshop::SkyGrid& grid) { return (grid.last.cast<double>() + 1).prod(); }

}  // namespace

SkyVolumeOnDevice::SkyVolumeOnDevice(Context& context, FogOnDevice& fog, const scene::Scene& scene,
                                     const airlight::fogshop::Model& model, const scene::Execution& execution)
    : grid_(model.gaussians, model.options.sky_cells),
      nodes_(context, "sky volume", std::size_t(node_count(grid_)) * 12) {
  const Use use_context(context);
  const std::vector<airlight::fogshop::SkyBeam> beams =
      airlight::fogshop::sky_beams(scene, model.options.sky_directions);
  const Buffer beam_buffer(context, "beams of the environment", beam_data(beams));
  // Once for the surfaces, by the tree that the host has of them.
  std::optional<airlight::fogshop::OpenBeams> open;
  if (scene.geometry) open.emplace(*scene.geometry, grid_, beams, execution);
  const Buffer open_buffer(context, "open beams", open ? open->bits : std::vector<std::uint32_t>());
  Program& p = fog.program(
      "fogshop/sky_volume.comp",
      {{"LOCAL_SIZE_X", "4"}, {"LOCAL_SIZE_Y", "4"}, {"LOCAL_SIZE_Z", "4"}, {"SURFACES", open ? "1" : "0"}});
  fog.bind();
  beam_buffer.bind(at::beams);
  if (open) {
    open_buffer.bind(at::open_beams);
    p.set("beam_words", int(open->words));
  }
  fog.use(p);
  use(p);
  const double each = model.gaussians.count + 2.0;  // loop iterations per beam; the one that ends a loop counts
  check_iterations(context, each, "the sky volume");
  const int count = int(beams.size()),
            step = int(std::clamp(std::min(most_iterations, most_pairs / node_count(grid_)) / each, 1.0, 65536.0));
  for (int first = 0; first < count; first += step) {
    p.set("first_beam", first);
    p.set("last_beam", std::min(count, first + step));
    p.dispatch(grid_.last[0] + 1, grid_.last[1] + 1, grid_.last[2] + 1);
  }
}

void SkyVolumeOnDevice::use(Program& p) const {
  p.set("grid_corner", grid_.corner);
  p.set("grid_cell", grid_.cell);
  p.set("grid_last", Vec3(grid_.last.cast<double>().matrix()));
  nodes_.bind(at::sky_volume);
}

}  // namespace airlight::gpu::fogshop
