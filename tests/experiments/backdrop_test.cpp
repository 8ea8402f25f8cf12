// Every renderer sees a medium before a picture with depth as its own airlight up to that depth and the picture behind it, or refuses it by
// name; in homogeneous media against closed forms.
#include "scene/backdrop.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/renderers.h"
#include "scene/scene.h"

namespace backdrop_test {

using namespace airlight;
using Catch::Contains;

namespace {

constexpr int width = 6, height = 4;

// A picture in which pixel i has the depth 1 + i / 2 and a colour of its own. The last pixel has infinite depth.
std::shared_ptr<const scene::Backdrop> picture() {
  scene::Backdrop backdrop{width, height, {}, {}, true};
  for (int i = 0; i < width * height; ++i) {
    for (int c = 0; c < 3; ++c) backdrop.radiance.push_back(float(0.1 + 0.02 * i + 0.1 * c));
    backdrop.depth.push_back(i + 1 < width * height ? float(1 + 0.5 * i) : float(infinity));
  }
  return std::make_shared<const scene::Backdrop>(backdrop);
}

const std::string film = "[film]\nwidth = 6\nheight = 4\n";
const std::string perspective = film + "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

std::shared_ptr<const scene::Scene> before_picture(const std::string& text, bool with_picture = true) {
  scene::Scene scene = scene::parse_scene(text, "s.toml", "");
  if (with_picture) scene.backdrops.push_back(picture());
  finish(scene);
  return std::make_shared<const scene::Scene>(std::move(scene));
}

scene::Film render(const std::string& name, const std::shared_ptr<const scene::Scene>& scene,
                   const std::map<std::string, std::string>& settings = {}) {
  const scene::Renderer& renderer = experiments::find_renderer(name, "test");
  return renderer.prepare(scene, scene::Settings(renderer.settings(), settings, name), {})
      ->render(view_of(*scene), {})
      .film;
}

const std::string puffs = R"([[medium]]
type = "gaussians"
sigma_t = [0.3, 0.4, 0.6]
gaussians = [{ center = [0, 0, -1], width = 2, amplitude = 1 }, { center = [1, 1, -4], width = 1.5, amplitude = 0.8 }]
)";
const std::string gaussians =
    perspective + "[[light]]\ntype = 'point'\nposition = [1, 3, 2]\nintensity = [30, 25, 20]\n" + puffs;
const std::string sunlit =
    perspective + "[[light]]\ntype = 'directional'\nto_light = [1, 3, 2]\nirradiance = 3\n" + puffs;
const std::string map = perspective + R"([[light]]
type = "directional"
to_light = [1, 3, 2]
irradiance = 3
[[medium]]
type = "fogmap"
sigma_t = [0.3, 0.4, 0.6]
cell = 2
corner = [-8, -12]
size = [8, 8]
values = [)" + [] {
  std::string values;
  for (int i = 0; i < 64; ++i) values += (i ? ", " : "") + std::to_string((i * 37) % 11);
  return values;
}() + "]\nregion = { type = \"slab\", lo = -2, hi = 2 }\n";

const std::string series = perspective + R"([[light]]
type = "directional"
to_light = [1, 3, 2]
irradiance = 3
[[medium]]
type = "legendre"
sigma_t = [0.3, 0.4, 0.6]
lo = [-3, -3, -8]
hi = [3, 3, 3]
size = [2, 1, 3]
coefficients = [2, 0.3, 0.2, 0.4, -0.1, 0.1]
)";

// A ray for every pixel, as the others have.
const std::map<std::string, std::string> of_every_pixel = {{"divide", "1"}, {"jitter", "none"}, {"steps", "64"}};

// With the media and lights that a renderer knows.
const std::string& text_for(const std::string& renderer) {
  return renderer == "wavelet_fog"                          ? map
         : renderer.starts_with("legendre_fluids")          ? series
         : renderer.starts_with("compensated_ray_marching") ? sunlit
                                                            : gaussians;
}

}  // namespace

TEST_CASE("renderers see a picture with depth through the medium before it", "[backdrop]") {
  const std::string name =
      GENERATE("ray_marcher", "half_resolution_march", "froxel_fog", "path_tracer", "deterministic", "fogshop",
               "wavelet_fog", "legendre_fluids", "compensated_ray_marching");
  CAPTURE(name);
  const auto scene = before_picture(text_for(name));
  const std::map<std::string, std::string> settings =
      name == "path_tracer"             ? std::map<std::string, std::string>{{"samples", "4"}, {"max_order", "1"}}
      : name == "half_resolution_march" ? of_every_pixel
      : name == "froxel_fog"            ? std::map<std::string, std::string>{{"tile", "1"}, {"slices", "1024"}}
                                        : std::map<std::string, std::string>{};
  const scene::Film seen = render(name, scene, settings);
  double greatest = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      CAPTURE(x, y);
      const int i = y * width + x;
      const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, width, height);
      const double t = i + 1 < width * height ? (1 + 0.5 * i) / ray.direction.dot(scene->camera.forward) : infinity;
      const Rgb clear = transmittance(scene->media, ray, {0, t});
      // Steps and slices are midpoints of a density that varies; Fogshop leaves out Gaussians where they are thin.
      const double tolerance = name == "ray_marcher" || name == "half_resolution_march" || name == "froxel_fog" ? 0.02
                               : name == "fogshop" || name == "compensated_ray_marching"                        ? 1e-4
                                                                                                                : 1e-5;
      for (int c = 0; c < 3; ++c) {
        CHECK(seen.get("transmittance", x, y)[c] == Approx(clear[c]).epsilon(tolerance));
        CHECK(seen.get("surface", x, y)[c] ==
              Approx(seen.get("transmittance", x, y)[c] * (0.1 + 0.02 * i + 0.1 * c)).epsilon(1e-5));
      }
      greatest = std::max(greatest, 1 - clear.minCoeff());
    }
  CHECK(greatest > 0.3);
}

TEST_CASE("the airlight before a picture is that before a wall at the same depth", "[backdrop]") {
  // A wall at z = -1 that reflects nothing and throws no shadow into what is before it, and a picture at that depth.
  const std::string wall =
      "[[surface]]\ntype = 'plane'\nnormal = [0, 0, 1]\npoint = [0, 0, -1]\nmaterial = { type = 'lambert', albedo = 0 }\n";
  const std::string name =
      GENERATE("ray_marcher", "half_resolution_march", "froxel_fog", "path_tracer", "deterministic", "fogshop");
  CAPTURE(name);
  const auto behind = before_picture(gaussians + wall, false);
  scene::Scene flat = scene::parse_scene(gaussians, "s.toml", "");
  scene::Backdrop black{width, height, std::vector<float>(3 * width * height, 0.0f),
                        std::vector<float>(width * height, 6.0f), true};
  flat.backdrops.push_back(std::make_shared<const scene::Backdrop>(black));
  finish(flat);
  const std::map<std::string, std::string> settings =
      name == "path_tracer"             ? std::map<std::string, std::string>{{"samples", "512"}, {"max_order", "1"}}
      : name == "half_resolution_march" ? of_every_pixel
                                        : std::map<std::string, std::string>{};
  const scene::Film one = render(name, behind, settings),
                    other = render(name, std::make_shared<const scene::Scene>(flat), settings);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double expected = one.get("airlight", x, y)[c], found = other.get("airlight", x, y)[c];
        if (name != "path_tracer") {
          CHECK(found == Approx(expected).epsilon(1e-5));
        } else {
          // Both are estimates: 5 standard errors of the difference, 144 of them, are exceeded once in 10^4 runs; seeds are fixed.
          const double a = one.get("se", x, y)[c], b = other.get("se", x, y)[c];
          CHECK(std::abs(found - expected) <= 5 * std::hypot(a, b));
        }
      }
}

TEST_CASE("mist over a picture agrees with closed forms where it is homogeneous", "[backdrop]") {
  // The light shines along the view (opposite to what is scattered), or against it; the medium is 3 m thick and begins 4 m ahead.
  const double sigma = 0.7, albedo = 0.8, thick = 3, irradiance = 2, phase = 1 / (4 * pi);
  const std::string name =
      GENERATE("ray_marcher", "half_resolution_march", "path_tracer", "deterministic", "legendre_fluids");
  const bool along_view = GENERATE(true, false);
  CAPTURE(name, along_view);
  const std::string text =
      film +
      "[camera]\ntype = 'orthographic'\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nheight = 3\n"
      "[[light]]\ntype = 'directional'\nirradiance = 2\nto_light = [0, 0, " +
      (along_view ? "1" : "-1") + "]\n" +
      "[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.7\nalbedo = 0.8\nregion = { type = 'box', lo = [-9, -9, -2], hi = [9, 9, 1] }\n";
  const auto scene = before_picture(text);
  const std::map<std::string, std::string> settings =
      name == "path_tracer"   ? std::map<std::string, std::string>{{"samples", "1024"}, {"max_order", "1"}}
      : name == "ray_marcher" ? std::map<std::string, std::string>{{"steps", "4096"}}
      : name == "half_resolution_march"
          ? std::map<std::string, std::string>{{"steps", "4096"}, {"divide", "1"}, {"jitter", "none"}}
          : std::map<std::string, std::string>{};
  const scene::Film seen = render(name, scene, settings);
  for (int i = 0; i < width * height; ++i) {
    CAPTURE(i);
    const double depth = i + 1 < width * height ? 1 + 0.5 * i : infinity;
    const double length = std::clamp(depth - 4, 0.0, thick);
    const double scattered = albedo * sigma * phase * irradiance;
    const double expected = along_view ? scattered * -std::expm1(-2 * sigma * length) / (2 * sigma)
                                       : scattered * length * std::exp(-sigma * thick);
    const double found = seen.get("airlight", i % width, i / width)[0];
    CHECK(seen.get("transmittance", i % width, i / width)[0] == Approx(std::exp(-sigma * length)).epsilon(1e-5));
    if (name == "path_tracer")
      CHECK(std::abs(found - expected) <= 5 * double(seen.get("se", i % width, i / width)[0]) + 1e-6);
    else
      CHECK(found == Approx(expected).epsilon(name == "deterministic" ? 1e-6 : 2e-5));
  }
}

TEST_CASE("a renderer that knows no backdrops refuses them by name", "[backdrop]") {
  const std::vector<std::string> know = {"ray_marcher",
                                         "ray_marcher_gpu",
                                         "half_resolution_march",
                                         "half_resolution_march_gpu",
                                         "froxel_fog",
                                         "froxel_fog_gpu",
                                         "path_tracer",
                                         "deterministic",
                                         "fogshop",
                                         "fogshop_gpu",
                                         "wavelet_fog",
                                         "wavelet_fog_gpu",
                                         "legendre_fluids",
                                         "legendre_fluids_gpu",
                                         "compensated_ray_marching",
                                         "compensated_ray_marching_gpu"};
  for (const std::string& name : experiments::renderer_names()) {
    CAPTURE(name);
    const scene::Renderer& renderer = experiments::find_renderer(name, "test");
    const auto reasons =
        renderer.supports(*before_picture(text_for(name)), scene::Settings(renderer.settings(), {}, name));
    const bool refused = std::any_of(reasons.begin(), reasons.end(),
                                     [](const std::string& r) { return r.find("backdrop") != std::string::npos; });
    CHECK(refused == (std::find(know.begin(), know.end(), name) == know.end()));
  }
}

TEST_CASE("a view through another camera than the scene's is refused where there is a backdrop", "[backdrop]") {
  const std::string name =
      GENERATE("ray_marcher", "half_resolution_march", "froxel_fog", "path_tracer", "deterministic", "fogshop",
               "wavelet_fog", "legendre_fluids", "compensated_ray_marching");
  const auto scene = before_picture(text_for(name));
  const scene::Renderer& renderer = experiments::find_renderer(name, "test");
  scene::View view = view_of(*scene);
  view.camera.position += Vec3(0.1, 0, 0);
  CHECK_THROWS_WITH(renderer.prepare(scene, scene::Settings(renderer.settings(), {}, name), {})->render(view, {}),
                    Contains("own camera"));
}

}  // namespace backdrop_test
