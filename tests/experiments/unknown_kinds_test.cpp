// A renderer refuses unknown kinds by name, and all renderers use the same words.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/renderers.h"
#include "scene/convert/residual.h"
#include "scene/math/legendre.h"
#include "scene/media/fitted.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"

namespace unknown_kinds_test {

using namespace airlight;

namespace {

std::vector<std::string> refusals(const scene::Renderer& renderer, const scene::Scene& scene) {
  return renderer.supports(scene, scene::Settings(renderer.settings(), {}));
}

bool has(const std::vector<std::string>& reasons, const std::string& reason) {
  return std::find(reasons.begin(), reasons.end(), reason) != reasons.end();
}

}  // namespace

TEST_CASE("renderers refuse fields and lights that they do not know in the same words", "[media]") {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {1, 1, 1};
  grid->values = {1.0f};
  scene::Scene scene;
  scene.name = "smoke";
  scene.width = scene.height = 4;
  scene.media.resize(1);
  scene.media[0].name = "smoke";
  scene.media[0].field = scene::GridPointer(grid);
  scene.lights = {scene::DirectionalLight{}};
  scene::finish(scene);
  int fogshop = 0, shadow_planes = 0, wavelet_fog = 0, legendre_fluids = 0, others = 0;
  for (const auto& renderer : experiments::all_renderers()) {
    const std::string name = renderer->name();
    CAPTURE(name);
    const auto reasons = refusals(*renderer, scene);
    if (name.starts_with("fogshop")) {
      ++fogshop;
      CHECK(has(reasons, "medium 'smoke' is grid, expected homogeneous or gaussians"));
      CHECK(has(reasons, "light 0 is directional, expected point or environment"));
    } else if (name.starts_with("shadow_planes")) {
      ++shadow_planes;
      CHECK(has(reasons, "medium 'smoke' is grid, expected homogeneous"));
      CHECK(has(reasons, "light 0 is directional, expected point or spot"));
    } else if (name.starts_with("wavelet_fog")) {
      ++wavelet_fog;
      CHECK(has(reasons, "medium 'smoke' is grid, expected fogmap"));
    } else if (name.starts_with("legendre_fluids")) {
      ++legendre_fluids;
      CHECK(has(reasons, "medium 'smoke' is grid, expected legendre or homogeneous"));
    } else {
      ++others;
      CHECK(reasons.empty());
    }
  }
  CHECK(fogshop == 2);
  CHECK(shadow_planes == 2);
  CHECK(wavelet_fog == 2);
  CHECK(legendre_fluids == 2);
  CHECK(others >= 10);  // and methods that somebody added
}

TEST_CASE("a Legendre box is rendered by the references and its own method, and refused by name by all others",
          "[media][legendre]") {
  scene::Scene scene;
  scene.width = scene.height = 4;
  scene.media.resize(1);
  scene.media[0].name = "cloud";
  scene.media[0].field = std::make_shared<const scene::LegendreBox>(
      Box{Point3::Constant(-1), Point3::Constant(1)}, scene::TensorShape{1, 1, 1}, Eigen::VectorXd::Constant(1, 2));
  scene.lights = {scene::DirectionalLight{}};
  scene::finish(scene);
  const std::map<std::string, std::string> expected = {{"path_tracer", ""},
                                                       {"legendre_fluids", ""},
                                                       {"legendre_fluids_gpu", ""},
                                                       {"compensated_ray_marching", ""},
                                                       {"compensated_ray_marching_gpu", "gaussians or grid or fitted"},
                                                       {"deterministic", ""},
                                                       {"ray_marcher", ""},
                                                       {"half_resolution_march", ""},
                                                       {"half_resolution_march_gpu", ""},
                                                       {"froxel_fog", ""},
                                                       {"froxel_fog_gpu", ""},
                                                       {"ray_marcher_gpu", ""},
                                                       {"fogshop", "homogeneous or gaussians"},
                                                       {"fogshop_gpu", "homogeneous or gaussians"},
                                                       {"shadow_planes", "homogeneous"},
                                                       {"shadow_planes_gpu", "homogeneous"},
                                                       {"wavelet_fog", "fogmap"},
                                                       {"wavelet_fog_gpu", "fogmap"}};
  for (const auto& renderer : experiments::all_renderers()) {
    const std::string name = renderer->name();
    CAPTURE(name);
    const auto reasons = refusals(*renderer, scene);
    if (expected.count(name) == 0) {  // a method that somebody added renders the medium, or names it
      CHECK(std::all_of(reasons.begin(), reasons.end(), [](const std::string& r) { return !r.empty(); }));
      CHECK((reasons.empty() || reasons.front().find("'cloud'") != std::string::npos));
      continue;
    }
    if (expected.at(name).empty())
      CHECK(reasons.empty());
    else
      CHECK(has(reasons, "medium 'cloud' is legendre, expected " + expected.at(name)));
  }
}

TEST_CASE("a fitted grid is rendered by whoever renders grids, to the same bits, and refused by name by all others",
          "[media][residual]") {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {5, 6, 4};
  grid->voxel_size = 0.3;
  grid->translation = {-0.6, -0.7, -0.5};
  for (int i = 0; i < 120; ++i) grid->values.push_back(float(std::max(0.0, 0.5 + std::sin(0.9 * i))));
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians.gaussians = {{{0, 0, 0}, 0.5, 0.4}};
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(*grid, fitted->gaussians, {0, {}}));
  fitted->grid = *grid;
  const auto scene_of = [](const scene::DensityField& field) {
    auto scene = std::make_shared<scene::Scene>();
    scene->width = scene->height = 6;
    scene->camera = scene::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
    scene->media.resize(1);
    scene->media[0].name = "smoke";
    scene->media[0].field = field;
    scene->lights = {scene::DirectionalLight{}};
    scene::finish(*scene);
    return scene;
  };
  const auto a = scene_of(scene::GridPointer(grid)), b = scene_of(scene::FittedPointer(fitted));
  CHECK(a->hash != b->hash);
  int rendered = 0, refused = 0;
  for (const auto& renderer : experiments::all_renderers()) {
    const std::string name = renderer->name();
    CAPTURE(name);
    const auto reasons = refusals(*renderer, *b);
    if (!refusals(*renderer, *a).empty()) {
      ++refused;
      CHECK(std::any_of(reasons.begin(), reasons.end(), [](const std::string& reason) {
        return reason.starts_with("medium 'smoke' is fitted, expected ");
      }));
      continue;
    }
    CHECK(reasons.empty());
    if (!renderer->device().empty() && !gpu::test::device()) continue;
    const scene::Settings settings(renderer->settings(), name == "path_tracer"
                                                             ? std::map<std::string, std::string>{{"samples", "4"}}
                                                             : std::map<std::string, std::string>{});
    const auto film = [&](const std::shared_ptr<const scene::Scene>& scene) {
      return renderer->prepare(scene, settings, {})->render(scene::view_of(*scene), {}).film.layer("mean");
    };
    const auto mean = film(a);
    CHECK(*std::max_element(mean.begin(), mean.end()) > 0);
    CHECK(film(b) == mean);
    ++rendered;
  }
  CHECK(refused == 8);
  CHECK(rendered >= 3);
}

}  // namespace unknown_kinds_test
