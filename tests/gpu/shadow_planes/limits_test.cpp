// Capacity of a device for crossings, lists and loops, and work that is left out.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gpu/program.h"
#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "tests/gpu/shader_folder.h"
#include "tests/gpu/shadow_planes/pictures.h"

namespace limits_test {

using namespace airlight;
using gpu::test::compare;
using gpu::test::Pairs;
using gpu::test::render;
using gpu::test::scene_of;

namespace {

// Shadows of more plates than a pixel's list holds, one after the other along every ray.
std::shared_ptr<scene::Scene> plates(int count) {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "plates";
  scene->width = 24;
  scene->height = 18;
  scene->camera = scene::look_at({-9, 0, 0.3}, {0, -0.4, 0}, {0, 1, 0});
  scene->lights.emplace_back(scene::PointLight{{0.1, 6, 0.2}, Rgb(50, 40, 30), 0.01});
  scene->media.resize(1);
  scene->media[0].sigma_t = Rgb(0.05, 0.1, 0.2);
  for (int i = 0; i < count; ++i) {
    const double x = -4 + 8.0 * i / count;
    scene->surfaces.push_back({"plate", scene::make_box({{x, 2, -2}, {x + 3.0 / count, 2.1, 2}}), scene::Lambert{}});
  }
  scene->surfaces.push_back({"wall", scene::Plane{{8, 0, 0}, {1, 0, 0}}, scene::Lambert{}});
  finish(*scene);
  return scene;
}

}  // namespace

DEVICE_TEST_CASE("shadow planes: more crossings than a pixel holds", "[gpu][shadow_planes]") {
  const auto scene = plates(60);
  compare(scene, {});
  compare(scene, {{"shadows", "signed_sum"}});
  compare(scene, {{"shadows", "stencil"}}, 2e-5, 1.5e-5);
  const scene::Rendering many = render(gpu::shadow_planes::ShadowPlanes(), scene, {});
  CHECK(many.counters.at("gatherings_after_first") > 100);
  CHECK(many.counters.at("crossings") == render(shadow_planes::ShadowPlanes(), scene, {}).counters.at("crossings"));
}

DEVICE_TEST_CASE("shadow planes: what a scene has not costs no dispatch", "[gpu][shadow_planes]") {
  const gpu::shadow_planes::ShadowPlanes method;
  const auto dispatches = [&](const scene::Scene& s, const Pairs& given) {
    auto scene = std::make_shared<scene::Scene>(s);
    finish(*scene);
    const auto prepared = method.prepare(scene, {method.settings(), given}, {1, {}});
    return prepared->render(view_of(*scene), {1, {}}).counters;
  };
  const scene::Scene boxes = *scene_of("shadow_planes/boxes_3", 32, 24);
  // First hits, m at the camera, three of the fan, the light, the layers.
  CHECK(dispatches(boxes, {}).at("dispatches") == 7);
  scene::Scene empty = boxes;
  empty.surfaces.clear();
  CHECK(dispatches(empty, {}).at("dispatches") == 3);  // the light is a ball
  empty.lights.clear();
  CHECK(dispatches(empty, {}).at("dispatches") == 1);
  CHECK(dispatches(empty, {}).at("draws") == 0);
}

// A hundred crossings on a ray and thousands of edges beside it: llvmpipe's limit on loops is not met, or said to be.
DEVICE_TEST_CASE("shadow planes: a hundred thousand edges on the device", "[gpu][shadow_planes][thorough]") {
  const auto scene = std::make_shared<scene::Scene>(scene::load_scene(
      AIRLIGHT_SOURCE_DIR "/experiments/scenes/shadow_planes/edges.toml", {{"film.width", "20"},
                                                                           {"film.height", "15"},
                                                                           {"surface.0.boxes", "16641"},
                                                                           {"surface.0.columns", "129"},
                                                                           {"surface.0.lot", "0.0775193798"}}));
  compare(scene, {});
  CHECK(render(gpu::shadow_planes::ShadowPlanes(), scene, {}).counters.at("gatherings_after_first") > 100);
  if (!context.software()) return;
  const auto media = scene_of("shadow_planes/media", 16, 12);
  for (const Pairs& given :
       {Pairs{{"nodes", "1024"}}, Pairs{{"nodes", "1024"}, {"shadows", "stencil"}, {"evaluation", "vertices"}}})
    CHECK_THROWS_AS(render(gpu::shadow_planes::ShadowPlanes(), media, given), Unavailable);
}

// Crossings at the ends of a plane: `times` may be any number, infinity too, which is no level.
DEVICE_TEST_CASE("shadow planes: a plane is crossed within its mesh, however far out", "[gpu][shadow_planes]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/plane_mesh.glsl"
layout(std430, binding = 0) readonly buffer Places { vec2 places[]; };  // share of the edge, times as far as it
layout(std430, binding = 1) writeonly buffer Found { vec4 found[]; };
uniform int place_count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= place_count) return;
  ivec3 corners;
  vec3 weight;
  locate_on_plane(0.3, 2, places[i].x, places[i].y, corners, weight);
  found[2 * i] = vec4(corners, 0);
  found[2 * i + 1] = vec4(weight, 0);
}
)");
  const float infinite = std::numeric_limits<float>::infinity();
  std::vector<std::array<float, 2>> places;
  for (const float share : {0.0f, 0.3f, 0.5f, 1.0f})
    for (const float times : {0.5f, 1.0f, 3.0f, 1e30f, 3e38f, infinite}) places.push_back({share, times});
  gpu::Program program(context, "test.comp", {{"LOCAL_SIZE_X", "32"}});
  const gpu::Buffer input(context, "places", places), output(context, "found", 32 * places.size());
  input.bind(0);
  output.bind(1);
  const int levels = 8;
  program.set("plane_levels", levels);
  program.set("place_count", int(places.size()));
  program.dispatch(int(places.size()));
  const std::vector<float> found = output.download<float>();
  for (std::size_t i = 0; i < places.size(); ++i) {
    CAPTURE(places[i][0], places[i][1]);
    const float *corners = &found[8 * i], *weight = corners + 4;
    for (int k = 0; k < 3; ++k) {
      CHECK(corners[k] >= 0);
      CHECK(corners[k] < 3 * (levels + 2));
      CHECK((weight[k] >= -1e-6 && weight[k] <= 1 + 1e-6));
    }
    CHECK(weight[0] + weight[1] + weight[2] == Approx(1));
    if (places[i][1] > 1e20f) CHECK(int(corners[2]) % (levels + 2) == levels + 1);  // the vertex at infinity
  }
}

}  // namespace limits_test
