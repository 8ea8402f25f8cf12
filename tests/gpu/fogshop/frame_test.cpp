// What a warm frame of Fogshop costs beside its dispatches.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/fogshop/fogshop_gpu.h"
#include "gpu/program.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"

namespace frame_test {

using namespace airlight;
using Pairs = std::map<std::string, std::string>;

namespace {

std::shared_ptr<const scene::Scene> scene_of(const char* name) {
  return std::make_shared<scene::Scene>(
      scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/") + name,
                        {{"film.width", "21"}, {"film.height", "15"}}));
}

// Counters of a frame that only differs from the one before in its camera.
std::map<std::string, double> warm(const scene::Scene& scene, const scene::Prepared& prepared,
                                   const scene::Execution& execution) {
  scene::View view = view_of(scene);
  prepared.render(view, execution);
  view.camera.position += Vec3(0.01, 0, 0);
  return prepared.render(view, execution).counters;
}

}  // namespace

TEST_CASE("fogshop: a warm frame allocates nothing, sends nothing and waits once", "[gpu]") {
  if (!gpu::test::device()) return;
  const gpu::FogshopGpu method;
  struct Case {
    const char* scene;
    Pairs given;
    int dispatches;
  };
  // Distances, tiles, what each pass of the airlight takes, surfaces or background, composition.
  for (const Case& c :
       {Case{"f100.toml", {}, 9}, Case{"f100.toml", {{"variant", "paper"}, {"reflectance", "npsf"}}, 6},
        Case{"posts.toml", {{"downsample", "4"}}, 17},
        Case{"posts.toml", {{"downsample", "4"}, {"variant", "paper"}}, 10}, Case{"environment_cloud.toml", {}, 5},
        Case{"environment_cloud.toml", {{"environment_airlight", "volume"}}, 6}}) {
    const auto scene = scene_of(c.scene);
    const auto prepared = method.prepare(scene, {method.settings(), c.given}, {1, {}});
    scene::Execution alone{1, {}};
    alone.layers.emplace();
    auto counters = warm(*scene, *prepared, alone);
    CAPTURE(c.scene, c.given);
    CHECK(counters.at("bytes_up") == 0);
    CHECK(counters.at("bytes_down") == 0);
    CHECK(counters.at("syncs") == 1);
    CHECK(counters.at("allocations") == 0);
    CHECK(counters.at("look_ups") == 0);
    CHECK(counters.at("dispatches") == c.dispatches);
    alone.layers->insert("mean");
    counters = warm(*scene, *prepared, alone);
    CHECK(counters.at("bytes_down") == 21 * 15 * 12);
    CHECK(counters.at("syncs") == 1);
    CHECK(prepared->render(view_of(*scene), alone).film.layers.size() == 1);
  }
}

// GLSL's own may have the absolute error of a sine, and none of its digits for a small angle.
TEST_CASE("tangents of small angles on the device", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  const gpu::Use use(*context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/angle.glsl"
layout(std430, binding = 0) buffer Values { float values[]; };
void main() { values[gl_GlobalInvocationID.x] = tangent(values[gl_GlobalInvocationID.x]); }
)");
  gpu::Program program(*context, "test.comp", {});
  std::vector<float> angles;
  for (float x = 1e-30f; x < 0.47f; x *= 1.01f) angles.insert(angles.end(), {x, -x});
  const gpu::Buffer values(*context, "angles", angles);
  values.bind(0);
  program.dispatch(int(angles.size()));
  const std::vector<float> got = values.download<float>();
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i)
    worst = std::max(worst, std::abs(got[i] / std::tan(double(angles[i])) - 1));
  CHECK(worst < 2.5e-7);
}

}  // namespace frame_test
