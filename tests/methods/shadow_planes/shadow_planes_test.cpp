// Whole pictures against the deterministic reference, which integrates every ray between its own shadow edges.
#include "methods/shadow_planes/shadow_planes.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/renderer.h"
#include "scene/geometry/shapes.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace shadow_planes_test {

using namespace airlight;
using Given = std::map<std::string, std::string>;
using airlight::test::render;

namespace {

// Greatest |a - b| over the greatest a, of a layer.
double difference(const scene::Film& a, const scene::Film& b, const std::string& layer,
                  const std::vector<unsigned char>& left_out) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  double most = 0, worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (left_out[i / 3]) continue;
    most = std::max(most, double(x[i]));
    worst = std::isfinite(y[i]) ? std::max(worst, std::abs(double(x[i]) - y[i])) : infinity;
  }
  return worst == 0 ? 0 : worst / most;  // both dark
}

// Both are quadratures to 1e-12 or better: films hold single precision.
void check(const std::shared_ptr<scene::Scene>& scene) {
  const auto reference = deterministic::make_renderer();
  const scene::Film expected = render(*reference, scene, {}).film;
  const scene::Film got = render(shadow_planes::ShadowPlanes(), scene, {}).film;
  const std::vector<unsigned char> left_out = ball_mask(*scene, view_of(*scene));
  for (const char* layer : {"airlight", "surface", "transmittance"}) {
    CAPTURE(scene->name, layer, difference(expected, got, layer, left_out));
    CHECK(difference(expected, got, layer, left_out) < 1e-6);
  }
}

std::shared_ptr<scene::Scene> boxes() {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "boxes";
  scene->width = 48;
  scene->height = 36;
  scene->camera = scene::look_at({0.5, 1, 5}, {0, 0, 0}, {0, 1, 0});
  scene->lights.emplace_back(scene::PointLight{{0.3, 2.5, -0.4}, Rgb(5, 4, 3), 0.02});
  scene->media.resize(1);
  scene->media[0].sigma_t = Rgb(0.1, 0.2, 0.4);
  scene->media[0].albedo = Rgb(0.9, 0.8, 1);
  scene->surfaces = {{"a", scene::make_box({{-1, -0.5, -1}, {-0.4, 0.3, -0.2}}), scene::Lambert{}},
                     {"b", scene::make_box({{0.1, 0.2, -0.5}, {0.7, 0.6, 0.4}}), scene::Lambert{}},
                     {"c", scene::make_box({{0.2, -0.7, -0.7}, {0.9, -0.2, 0.1}}), scene::Lambert{}},
                     {"floor", scene::Plane{{0, -1, 0}, {0, 1, 0}}, scene::Lambert{}}};
  finish(*scene);
  return scene;
}

}  // namespace

TEST_CASE("shadow planes agree with the deterministic reference", "[shadow_planes]") {
  const auto scene = boxes();
  check(scene);
  scene->name = "two lights, one in a box, forward scattering";
  scene->media[0].phase = scene::HenyeyGreenstein{0.8};
  scene->lights.emplace_back(scene::PointLight{{0.4, 0.4, 0}, Rgb(1, 2, 3), 0.01});
  finish(*scene);
  check(scene);
  scene->name = "camera in a box";
  scene->camera = scene::look_at({-0.7, 0, -0.5}, {0, 0, 0}, {0, 1, 0});
  check(scene);
  scene->name = "orthographic";
  scene->camera = scene::look_at({0.5, 1, 5}, {0, 0, 0}, {0, 1, 0});
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = 4;
  check(scene);
  scene->name = "a spot";
  scene->lights = {scene::SpotLight{{0.3, 2.5, -0.4}, Vec3(-0.1, -1, 0.2).normalized(), 0.3, 0.5, Rgb(5, 4, 3), 0.02}};
  finish(*scene);
  check(scene);
}

TEST_CASE("shadow planes in bounded media agree with the deterministic reference", "[shadow_planes]") {
  const auto scene = boxes();
  scene->name = "three media";
  scene->surfaces.resize(1);
  scene->media.resize(3);
  scene->media[0].region = scene::Sphere{{-1, 0, -1}, 0.9};
  scene->media[0].sigma_t = Rgb(2, 0.1, 0.1);
  scene->media[1].region = scene::Sphere{{1, 0.2, -1}, 0.9};
  scene->media[1].sigma_t = Rgb(0.1, 2, 0.1);
  scene->media[2].region = Box{{-0.6, -0.9, 0.2}, {0.5, 0.1, 1.2}};
  scene->media[2].sigma_t = Rgb(0.1, 0.1, 2);
  finish(*scene);
  check(scene);
}

TEST_CASE("shadow planes: the elephant agrees with the deterministic reference", "[shadow_planes]") {
  const auto scene = std::make_shared<scene::Scene>(scene::load_scene(
      AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_fog.toml", {{"film.width", "32"}, {"film.height", "24"}}));
  check(scene);
}

// The paper's "shadow in shadow": without counting, light is subtracted once for every layer.
TEST_CASE("shadow planes: a signed sum is wrong where shadows overlap", "[shadow_planes]") {
  const auto scene = boxes();
  const shadow_planes::ShadowPlanes method;
  const scene::Film counted = render(method, scene, {}).film,
                    plain = render(method, scene, {{"shadows", "signed_sum"}}).film;
  const scene::Film none = render(method, scene, {{"shadows", "none"}}).film;
  int darker = 0;
  for (std::size_t i = 0; i < counted.pixels() * 3; ++i) {
    const double c = counted.layer("airlight")[i], s = plain.layer("airlight")[i], n = none.layer("airlight")[i];
    CHECK(c <= n * (1 + 1e-6));
    CHECK(s <= c + 1e-6 * n);
    darker += s < c - 1e-3 * n;
  }
  CHECK(darker > 30);
  // One convex occluder: nothing overlaps.
  const auto one = boxes();
  one->surfaces.resize(1);
  finish(*one);
  CHECK(difference(render(method, one, {}).film, render(method, one, {{"shadows", "signed_sum"}}).film, "airlight",
                   std::vector<unsigned char>(one->width * std::size_t(one->height), 0)) < 1e-6);
}

// The paper's order is that of the middles of edges: wrong for some pixels, for fewer the finer edges are split.
TEST_CASE("shadow planes: the stencil's order is wrong in some pixels", "[shadow_planes]") {
  const auto scene = boxes();
  const shadow_planes::ShadowPlanes method;
  const scene::Film counted = render(method, scene, {}).film, none = render(method, scene, {{"shadows", "none"}}).film;
  int before = 1 << 20;
  for (const char* pieces : {"1", "4", "16", "256"}) {
    const scene::Film film = render(method, scene, {{"shadows", "stencil"}, {"edge_split", pieces}}).film;
    int wrong = 0;
    for (std::size_t i = 0; i < film.pixels() * 3; i += 3)
      wrong += std::abs(film.layer("airlight")[i] - counted.layer("airlight")[i]) > 1e-4 * none.layer("airlight")[i];
    CAPTURE(pieces, wrong, before);
    CHECK(wrong <= before);
    CHECK((wrong > 0 || before < 1 << 20));  // with whole edges some are
    before = wrong;
  }
  CHECK(before <= 2);
  // A frame buffer of 8 bits: half a step for each plane, and what is above 1 is lost.
  const scene::Film coarse =
      render(method, scene, {{"shadows", "stencil"}, {"edge_split", "256"}, {"frame_buffer", "true"}}).film;
  double most = 0;
  for (std::size_t i = 0; i < coarse.pixels() * 3; ++i) {
    CHECK(coarse.layer("airlight")[i] <= 1);
    most = std::max(most, std::abs(double(coarse.layer("airlight")[i]) - counted.layer("airlight")[i]));
  }
  CHECK((most > 0.5 / 255 && most < 0.1));
}

TEST_CASE("shadow planes: what a scene has not is left out", "[shadow_planes]") {
  const shadow_planes::ShadowPlanes method;
  const auto scene = boxes();
  const auto kept = [&](const Given& given) {
    std::vector<std::string> names;
    for (const scene::Stage& stage : method.prepare(scene, {method.settings(), given}, {1, {}})->stages())
      if (stage.kept) names.push_back(stage.name);
    return names;
  };
  CHECK(kept({}) == std::vector<std::string>{"silhouettes", "airlight", "surfaces"});
  CHECK(kept({{"shadows", "none"}}) == std::vector<std::string>{"airlight", "surfaces"});
  scene->media.clear();
  CHECK(kept({}) == std::vector<std::string>{"surfaces"});
  CHECK(render(method, scene, {}).counters.at("lit_parts") == 0);
  scene->lights.clear();
  CHECK(kept({}).empty());
  scene->lights.emplace_back(scene::DirectionalLight{});
  CHECK_FALSE(method.supports(*scene, {method.settings(), {}}).empty());
}

}  // namespace shadow_planes_test
