// Rules for the picture of every renderer, on a scene of each kind that a renderer may know or refuse.
#include "tests/pictures.h"

#include "experiments/application/renderers.h"
#include "tests/gpu/device.h"

namespace pictures_test {

using namespace airlight;
using scene::Film;
using scene::Prepared;
using test::Given;
using SharedScene = std::shared_ptr<const scene::Scene>;

namespace {

constexpr int width = 16, height = 12;
constexpr double single_precision = 6e-7;

using Names = std::vector<const char*>;
// One for each kind of medium and light.
const Names few{"constant_homogeneous",
                "crosscheck/sphere_hg_directional",
                "fogshop/f100",
                "legendre_cloud",
                "shadow_planes/boxes_3",
                "wavelet_fog/patchy",
                "compensated_ray_marching/gaussians_lobe"};
const Names more{"constant_grid",
                 "elephant_fog",
                 "furnace",
                 "crosscheck/box_point_outside",
                 "crosscheck/grid_coloured_point",
                 "crosscheck/mesh_in_fog",
                 "fogshop/environment_cloud",
                 "fogshop/posts",
                 "shadow_planes/media",
                 "wavelet_fog/valley"};

// Settings that do as little work as shows the same layers.
Given little_work(const scene::Renderer& renderer) {
  const std::string name = renderer.name();
  if (renderer.monte_carlo()) return {{"samples", "16"}};
  if (name == "deterministic") return {{"relative_tolerance", "1e-3"}};
  if (name.starts_with("half_resolution_march"))
    return {{"steps", "8"}, {"environment_directions", "8"}, {"map_size", "32"}, {"map_steps", "32"}};
  if (name.starts_with("ray_marcher")) return {{"steps", "8"}, {"shadow_steps", "4"}};
  if (name.starts_with("froxel_fog"))
    return {{"tile", "4"}, {"slices", "16"}, {"map_size", "32"}, {"environment_directions", "8"}};
  return {};
}

// A path tracer's airlight is scattered once, its mean as often as light likes.
void check_film(const Film& film, bool parts_fit) {
  CHECK((film.width == width && film.height == height));
  CHECK(test::all_finite(film));
  for (const auto& [name, values] : film.layers) CHECK(values.size() == 3 * film.pixels());
  if (!parts_fit) return;
  const auto& mean = film.layer("mean");
  std::vector<float> sum(mean.size(), 0);
  for (const char* part : {"airlight", "surface", "ambient"})
    if (film.layers.count(part)) {
      const auto& values = film.layer(part);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
    }
  if (film.layers.count("airlight") && film.layers.count("surface"))
    CHECK(test::relative_l2(mean, sum) <= single_precision);
}

// The next frame of a preparation is the picture of one made anew, or there is none and the preparation stays what it was.
// Systems that begin with the last frame's solution end within their tolerance of it.
void check_next(const scene::Renderer& renderer, const Given& given, const SharedScene& before,
                const SharedScene& after) {
  const scene::Settings settings{renderer.settings(), given};
  const auto prepared = renderer.prepare(before, settings, {1, {}});
  const Film first = prepared->render(view_of(*before), {1, {}}).film;
  const bool goes_on = prepared->next(after, {1, {}}).has_value();
  const SharedScene& now = goes_on ? after : before;
  const Film next = prepared->render(view_of(*now), {1, {}}).film;
  const Film anew = goes_on ? test::picture(renderer, after, given) : first;
  for (const auto& [layer, values] : anew.layers) {
    CAPTURE(layer);
    CHECK(test::relative_l2(next.layer(layer), values) <= (goes_on ? 2e-3 : 0));
  }
}

void check_moves(const scene::Renderer& renderer, const Given& given, const scene::Scene& still) {
  const auto moved = [&](const std::string& what, auto&& move) {
    CAPTURE(what);
    auto next = std::make_shared<scene::Scene>(still);
    move(*next);
    finish(*next);
    if (renderer.supports(*next, {renderer.settings(), given}).empty())
      check_next(renderer, given, std::make_shared<scene::Scene>(still), next);
  };
  moved("camera", [](scene::Scene& s) { s.camera.position += Vec3(0.01, 0.02, -0.01); });
  moved("lights", [](scene::Scene& s) {
    for (scene::Light& light : s.lights) light = scene::turned(scene::moved(light, Vec3(0.02, 0.03, -0.01)), 0.1);
  });
  moved("dimmed lights", [](scene::Scene& s) {
    for (scene::Light& light : s.lights) {
      if (auto* point = std::get_if<scene::PointLight>(&light)) point->intensity *= 0.5;
      if (auto* spot = std::get_if<scene::SpotLight>(&light)) spot->intensity *= 0.5;
      if (auto* sun = std::get_if<scene::DirectionalLight>(&light)) sun->irradiance *= 0.5;
      if (auto* sky = std::get_if<scene::EnvironmentLight>(&light)) sky->scale *= 0.5;
    }
  });
  const auto sum_of = [](scene::Scene& s) -> scene::GaussianSum* {
    for (scene::Medium& medium : s.media)
      if (auto* sum = std::get_if<scene::GaussianSum>(&medium.field); sum && sum->gaussians.size() > 1) return sum;
    return nullptr;
  };
  if (scene::Scene copy = still; sum_of(copy))
    moved("a Gaussian less", [&](scene::Scene& s) { sum_of(s)->gaussians.pop_back(); });
  moved("media", [](scene::Scene& s) {
    for (scene::Medium& medium : s.media) medium.sigma_t *= 0.9;
  });
}

// A picture that is stopped says so; one that looks at nobody on the way is whole.
void check_stop(const scene::Renderer& renderer, const SharedScene& scene, const Given& given, const Film& whole) {
  const scene::Execution stopped{1, [](double) { return false; }};
  try {
    const Film film =
        renderer.prepare(scene, {renderer.settings(), given}, stopped)->render(view_of(*scene), stopped).film;
    CHECK(film.layers == whole.layers);
  } catch (const scene::Interrupted&) {
  }
}

// How many of the scenes the renderer draws.
int check(const scene::Renderer& renderer, const Names& names) {
  const Given given = little_work(renderer);
  const bool on_device = renderer.name().ends_with("_gpu");
  int drawn = 0;
  for (const char* name : names) {
    CAPTURE(renderer.name(), name);
    const auto scene = test::scene_named(name, width, height);
    const scene::Settings settings{renderer.settings(), given};
    const std::vector<std::string> reasons = renderer.supports(*scene, settings);
    if (!reasons.empty()) {
      try {
        renderer.prepare(scene, settings, {1, {}});
        FAIL_CHECK("drawn, although supports() objects: " << reasons.front());
      } catch (const scene::NotSupported& refused) {
        CHECK(refused.reason == reasons.front());
        CHECK(std::string(refused.what()).find('\n') == std::string::npos);
      }
      continue;
    }
    ++drawn;
    const Film film = test::picture(renderer, scene, given, 1);
    check_film(film, !renderer.monte_carlo());
    if (!on_device) {
      CHECK(test::picture(renderer, scene, given, 2).layers == film.layers);
      check_stop(renderer, scene, given, film);
    }
    check_moves(renderer, given, *scene);
  }
  return drawn;
}

void check_all(bool on_device, const Names& names) {
  for (const auto& renderer : experiments::all_renderers()) {
    if (renderer->name().ends_with("_gpu") != on_device) continue;
    CAPTURE(renderer->name());
    CHECK(check(*renderer, names) >= 1);
  }
}

}  // namespace

TEST_CASE("pictures: layers fit, threads change nothing, frames go on, refusals are what supports() says", "[matrix]") {
  check_all(false, few);
}

TEST_CASE("pictures of more scenes: layers fit, threads change nothing, frames go on", "[matrix][thorough]") {
  check_all(false, more);
}

DEVICE_TEST_CASE("pictures of the device: layers fit, frames go on, refusals are what supports() says",
                 "[gpu][matrix]") {
  check_all(true, few);
}

}  // namespace pictures_test
