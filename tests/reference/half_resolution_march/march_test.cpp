// The march along one ray: closed forms, orders, and the plain march that it is at full resolution.
#include "reference/half_resolution_march/march.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/renderer.h"
#include "scene/picture.h"
#include "tests/reference/half_resolution_march/fog_scenes.h"

namespace half_march_test {

using namespace airlight;
using namespace airlight::half_resolution_march;
using test::relative_l2;

namespace {

constexpr double single = 3e-7;  // a film holds floats

// Over octaves of steps, from the first to the last.
double order(const std::vector<double>& errors) {
  return std::log2(errors.front() / errors.back()) / double(errors.size() - 1);
}

std::vector<double> errors_by_steps(const std::shared_ptr<const scene::Scene>& scene, const scene::Film& truth,
                                    const std::vector<int>& steps, const Given& more) {
  std::vector<double> errors;
  for (const int n : steps) errors.push_back(relative_l2(picture(scene, plain(n, more)), truth));
  return errors;
}

using Maps = std::vector<std::unique_ptr<light_map::LightMap>>;

// By plain loops over the scene's own functions, in double.
Rgb plain_airlight(const scene::Scene& scene, const std::vector<scene::Light>& lights, const Maps& maps, const Ray& ray,
                   const Stretch& stretch, int steps, Rgb& transmittance) {
  Rgb airlight = Rgb::Zero();
  const double h = stretch.t.length() / steps;
  for (int i = 0; i < steps && !stretch.t.empty(); ++i) {
    const Point3 x = ray.at(stretch.t.lo + (i + 0.5) * h);
    const Rgb extinction = scene::extinction(scene.media, x);
    Rgb source = Rgb::Zero();
    for (std::size_t l = 0; l < lights.size(); ++l) {
      const scene::Incident from = incident(lights[l], x);
      if (scene.geometry && scene.geometry->occluded({x, from.to_light}, from.distance)) continue;
      for (const scene::Medium& m : scene.media)
        source += m.albedo * m.sigma_t * density(m, x) * phase_value(m.phase, from.to_light.dot(ray.direction)) *
                  from.irradiance * (-maps[l]->optical_depth(x)).exp();
    }
    for (int c = 0; c < 3; ++c) {
      const double k = extinction[c];
      airlight[c] += transmittance[c] * source[c] * (k > 0 ? -std::expm1(-k * h) / k : h);
      transmittance[c] *= std::exp(-k * h);
    }
  }
  transmittance *= stretch.beyond;
  return airlight;
}

}  // namespace

// Whatever the number of steps and their offsets.
TEST_CASE("half-resolution march: analytic steps are exact where the source is constant", "[half_resolution_march]") {
  for (const double extinction : {1e-6, 1.0, 30.0, 1e6}) {
    const SlabOfFog fog{Rgb(0, 0.5, 2) * extinction};
    for (const char* steps : {"1", "5", "64"})
      for (const char* jitter : {"none", "bayer", "noise"}) {
        CAPTURE(extinction, steps, jitter);
        const scene::Film film =
            picture(fog.scene(), {{"self_shadow", "none"}, {"steps", steps}, {"jitter", jitter}, {"divide", "2"}});
        for (int y = 0; y < film.height; ++y)
          for (int x = 0; x < film.width; ++x)
            for (int c = 0; c < 3; ++c) {
              const Rgb exact = fog.airlight(fog.depth), clear = fog.transmittance(fog.depth);
              CHECK(film.get("airlight", x, y)[c] == Approx(exact[c]).epsilon(4 * single));
              CHECK(film.get("transmittance", x, y)[c] == Approx(clear[c]).epsilon(4 * single).margin(1e-37));
            }
      }
  }
}

// Its sum in closed form: the exact airlight times x / (exp(x) - 1), x the depth of a step. Too dark, by x / 2: order 1.
TEST_CASE("half-resolution march: Riemann steps are of order 1, and too dark", "[half_resolution_march]") {
  const SlabOfFog fog;
  std::vector<double> errors;
  for (const int n : {8, 16, 32, 64, 128}) {
    const scene::Film film = picture(fog.scene(1, 1), plain(n, {{"self_shadow", "none"}, {"integration", "riemann"}}));
    for (int c = 0; c < 3; ++c) {
      const double x = fog.extinction[c] * fog.depth / n;
      CAPTURE(n, c);
      CHECK(film.get("airlight", 0, 0)[c] == Approx(fog.airlight(fog.depth)[c] * x / std::expm1(x)).epsilon(single));
      CHECK(film.get("transmittance", 0, 0)[c] == Approx(fog.transmittance(fog.depth)[c]).epsilon(single));
    }
    errors.push_back(1 - film.get("airlight", 0, 0)[1] / fog.airlight(fog.depth)[1]);
  }
  CHECK(order(errors) == Approx(1).margin(0.05));
}

// Fog without end: cut at an optical depth of 16, beyond which exp(-16) = 1e-7 of the light is.
TEST_CASE("half-resolution march: endless fog ends at an optical depth of 16, or at the first hit",
          "[half_resolution_march]") {
  auto scene = ray_marcher::make_scene(
      {ray_marcher::make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb(0, 0.5, 2), Rgb::Constant(0.8))},
      {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Constant(3)}});
  const lit_media::LitMedia media(scene, {}, {1, {}});
  const Ray ray{Point3(1, 2, 3), -Vec3::UnitZ()};
  Stretch stretch = marched_stretch(media, ray, infinity, false);
  CHECK(stretch.t.lo == 0);
  CHECK(stretch.t.hi == 32);  // of the thinner channel
  CHECK((stretch.beyond == Rgb(1, 0, 0)).all());
  // Not as far as a wall behind that, with longer steps.
  stretch = marched_stretch(media, ray, 1000, false);
  CHECK(stretch.t.hi == 32);
  CHECK((stretch.beyond == Rgb(1, 0, 0)).all());
  stretch = marched_stretch(media, ray, 5, false);
  CHECK(stretch.t.hi == 5);
  CHECK((stretch.beyond == 1).all());
  // A ball of white fog far behind it is seen by the channel without fog.
  scene->media.push_back(
      ray_marcher::make_medium(scene::Homogeneous{1}, scene::Sphere{Point3(1, 2, -997), 10}, Rgb::Ones(), Rgb::Ones()));
  const lit_media::LitMedia both(scene, {}, {1, {}});
  stretch = marched_stretch(both, ray, infinity, false);
  CHECK(stretch.t.hi == Approx(1010));
  // No sunlight comes through endless fog of all channels, and no light from behind it.
  auto dark = ray_marcher::make_scene(
      {ray_marcher::make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb(1, 0.5, 2), Rgb::Constant(0.8))},
      {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Constant(3)}});
  dark->width = dark->height = 1;
  finish(*dark);
  const scene::Film film = picture(dark, {});
  CHECK((film.get("airlight", 0, 0) == 0).all());
  CHECK((film.get("transmittance", 0, 0) == 0).all());
}

TEST_CASE("half-resolution march: steps go from where media begin, or from the camera", "[half_resolution_march]") {
  const auto scene = ray_marcher::make_scene(
      {ray_marcher::make_medium(scene::Homogeneous{1}, scene::Sphere{Point3(0, 0, 0), 1}, Rgb::Ones(), Rgb::Ones())},
      {scene::PointLight{Point3(0, 3, 0), Rgb::Ones(), 0}});
  const lit_media::LitMedia media(scene, {}, {1, {}});
  const Ray ray{Point3(0, 0, 5), -Vec3::UnitZ()};
  CHECK(marched_stretch(media, ray, infinity, false).t.lo == Approx(4));
  CHECK(marched_stretch(media, ray, infinity, true).t.lo == 0);
  CHECK(marched_stretch(media, ray, infinity, true).t.hi == Approx(6));
  CHECK(marched_stretch(media, ray, 4.5, true).t.hi == 4.5);
  CHECK(marched_stretch(media, ray, 3, true).t.empty());
  CHECK(marched_stretch(media, {Point3(0, 2, 5), -Vec3::UnitZ()}, infinity, true).t.empty());
  // 120 steps from the camera have 40 in the ball: as 40 from where it begins.
  auto seen = std::make_shared<scene::Scene>(*scene);
  seen->camera = scene::look_at(ray.origin, Point3::Zero(), Vec3::UnitY());
  seen->width = seen->height = 1;
  finish(*seen);
  CHECK(relative_l2(picture(seen, plain(120, {{"interval", "camera"}})), picture(seen, plain(40))) < single);
}

// A lamp beside the rays, in endless fog before a black wall: the integrand is smooth from the camera to the wall, and the way of light
// through the fog is known in closed form.
TEST_CASE("half-resolution march: order 2 in steps at their middles, 1 where they are jittered",
          "[half_resolution_march]") {
  auto scene =
      ray_marcher::make_scene({ray_marcher::make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb(0.1, 0.2, 0.3),
                                                        Rgb(0.9, 0.7, 0.5), scene::HenyeyGreenstein{0.3})},
                              {scene::PointLight{Point3(1, 2.5, 1), Rgb(3, 2, 1), 0}});
  scene->surfaces = {{"wall", scene::Plane{Point3(0, 0, -1), Vec3::UnitZ()}, scene::Lambert{Rgb::Zero()}}};
  scene->camera = ray_marcher::small_view().camera;
  scene->width = 21;
  scene->height = 17;
  finish(*scene);
  const scene::Film truth = test::picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-9"}}, 2);
  const std::vector<int> steps = {8, 16, 32, 64, 128};
  const auto middle = errors_by_steps(scene, truth, steps, {});
  const auto bayer = errors_by_steps(scene, truth, steps, {{"jitter", "bayer"}});
  const auto noise = errors_by_steps(scene, truth, steps, {{"jitter", "noise"}});
  const auto riemann = errors_by_steps(scene, truth, steps, {{"integration", "riemann"}});
  CAPTURE(middle, bayer, noise, riemann);
  CHECK(order(middle) == Approx(2).margin(0.1));
  CHECK(order(bayer) == Approx(1).margin(0.1));
  CHECK(order(noise) == Approx(1).margin(0.1));
  CHECK(order(riemann) == Approx(1).margin(0.1));
  CHECK(middle.back() < 1e-4);
  CHECK(bayer.back() < 1e-2);
}

// All media, lights and surfaces that a scene may have. Densities by kernels are floats, so are depths from maps: 1e-5 of an
// optical depth of 10. A map of 8 directions stands for the sky.
TEST_CASE("half-resolution march: at full resolution it is a plain march", "[half_resolution_march]") {
  for (const auto& [name, made] : ray_marcher::assorted_scenes()) {
    INFO(name);
    auto scene = std::make_shared<scene::Scene>(*made);
    scene->camera = ray_marcher::small_view().camera;
    scene->width = 7;
    scene->height = 5;
    finish(*scene);
    const scene::Film film =
        picture(scene, plain(12, {{"environment_directions", "8"}, {"map_size", "16"}, {"map_steps", "16"}}));
    lit_media::Options options;
    options.environment_directions = 8;
    options.map.size = options.map.steps = 16;
    const lit_media::LitMedia media(scene, options, {1, {}});
    Maps maps;
    for (const scene::Light& light : media.lights())
      maps.push_back(std::make_unique<light_map::LightMap>(light, scene->media, options.map,
                                                           light_map::densities_of(scene->media), scene::Execution{}));
    double most = 0, error = 0, clear = 0;
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) {
        const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, 7, 5);
        const Stretch stretch = marched_stretch(media, ray, camera_end(*scene, ray).t, false);
        Rgb transmittance = Rgb::Ones();
        const Rgb airlight = plain_airlight(*scene, media.lights(), maps, ray, stretch, 12, transmittance);
        most = std::max(most, airlight.maxCoeff());
        error = std::max(error, (film.get("airlight", x, y) - airlight).abs().maxCoeff());
        clear = std::max(clear, (film.get("transmittance", x, y) - transmittance).abs().maxCoeff());
      }
    CHECK(error <= 1e-5 * most);
    CHECK(clear <= 1e-5);
    CHECK((most > 0) == !scene->media.empty());
  }
}

}  // namespace half_march_test
