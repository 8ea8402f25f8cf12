// Pictures with maps of the lights on the device against those of the processor.
#include "tests/gpu/ray_marcher/pictures.h"
#include "tests/pictures.h"

namespace map_parity_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

Given map_settings(const char* encoding) {
  return {{"steps", "30"},    {"environment_directions", "8"},
          {"shadow", "map"},  {"map_encoding", encoding},
          {"map_size", "40"}, {"map_steps", "50"}};
}

void agree(const std::string& name, const std::shared_ptr<const scene::Scene>& scene, const scene::View& view,
           const char* encoding) {
  const scene::Rendering cpu = render(scene, view, map_settings(encoding), 1),
                         gpu = render_gpu(scene, view, map_settings(encoding));
  CAPTURE(name, encoding);
  // Measured: 4.6e-6; of avsm 2.5e-5, which node goes may turn on rounding.
  gpu::test::agree(name + ", " + encoding, cpu.film, gpu.film, {encoding == std::string("avsm") ? 8e-5 : 1.4e-5},
                   {"airlight", "transmittance", "surface"});
  for (const char* counter : {"rays", "steps", "occlusion_rays", "look_ups", "shadow_rays", "shadow_steps"}) {
    CAPTURE(counter);
    CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(2e-3));
  }
  CHECK((gpu.counters.at("look_ups") > 0) == !scene->media.empty());
}

}  // namespace

// Grey and coloured media, Gaussians, grids, several together, surfaces under the sky; point, spot, directional lights.
DEVICE_TEST_CASE("ray marcher: pictures with maps on the GPU are those of the CPU", "[gpu][ray_marcher][light_map]") {
  for (const auto& [name, scene] : assorted_scenes())
    for (const char* encoding : {"slices", "avsm", "fourier", "beer"}) {
      const bool one_is_enough = name == "nothing" || name == "homogeneous sphere" || name == "unbounded fog" ||
                                 name == "slab and box" ||
                                 name == "overlap of all";  // the last comes again with surfaces
      if (one_is_enough && encoding != std::string("slices")) continue;
      agree(name, scene, look(), encoding);
    }
}

DEVICE_TEST_CASE("ray marcher: meshes behind media with maps on the GPU", "[gpu][ray_marcher][light_map]") {
  const auto scene = test::scene_named("elephant_fog", 48, 36);
  agree("elephant", scene, view_of(*scene), "slices");
}

// Maps that are made once are not made again, and the stages say so.
DEVICE_TEST_CASE("ray marcher: maps on the GPU are a stage of the preparation", "[gpu][ray_marcher][light_map]") {
  const auto scene = test::scene_named("plume_sun", 8, 6);
  const gpu::ray_marcher::RayMarcher marcher;
  const auto prepared = marcher.prepare(scene, {marcher.settings(), map_settings("beer")}, {1, {}});
  const auto times = prepared->prepare_times();
  CHECK(std::any_of(times.begin(), times.end(), [](const auto& time) { return time.name == "light_maps"; }));
  const auto stages = prepared->stages();
  CHECK(std::any_of(stages.begin(), stages.end(), [](const auto& s) { return s.name == "light_maps" && s.kept; }));
  CHECK(prepared->render(view_of(*scene), {1, {}}).counters.at("dispatches") <= 3);
}

}  // namespace map_parity_test
