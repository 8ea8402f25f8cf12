// Whole pictures: the variants against each other, and the medium as the references see it.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/judging/equality.h"
#include "methods/fogshop/fogshop.h"
#include "methods/wavelet_fog/polar_table.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/renderer.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "tests/pictures.h"

namespace variants_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const wavelet_fog::WaveletFog method;

// Root mean square of the difference.
double rms(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  double sum = 0;
  const auto &x = a.layer(layer), &y = b.layer(layer);
  for (std::size_t i = 0; i < x.size(); ++i) sum += (double(x[i]) - y[i]) * (double(x[i]) - y[i]);
  return std::sqrt(sum / double(x.size()));
}

double most(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  double greatest = 0;
  const auto &x = a.layer(layer), &y = b.layer(layer);
  for (std::size_t i = 0; i < x.size(); ++i) greatest = std::max(greatest, std::abs(double(x[i]) - y[i]));
  return greatest;
}

// With another eye.
std::shared_ptr<scene::Scene> seen_from(std::shared_ptr<scene::Scene> scene, const Point3& eye, const Point3& at) {
  const double fov = scene->camera.vertical_fov;
  scene->camera = scene::look_at(eye, at, Vec3::UnitY());
  scene->camera.vertical_fov = fov;
  return scene;
}

const std::pair<Point3, Point3> views[] = {
    {{-12, 2, -22}, {3, 1.5, 8}}, {{0, 1, 0}, {10, 0.5, 3}}, {{-60, 9, -45}, {0, 2, 0}}, {{5, 25, 5}, {6, 0, 5.5}}};

}  // namespace

TEST_CASE("wavelet fog: skip equals direct, polar is off by 1e-4, bound below its tolerance", "[wavelet_fog]") {
  for (const std::string name : {"smooth", "patchy", "hard"})
    for (const auto& [eye, at] : views) {
      const auto scene = seen_from(scene_named("wavelet_fog/" + name, 48, 36), eye, at);
      const scene::Film direct = picture(method, scene, {{"variant", "direct"}});
      CAPTURE(name, eye.transpose());
      CHECK(most(picture(method, scene, {{"variant", "skip"}}), direct, "transmittance") <= 2e-7);
      CHECK(rms(picture(method, scene, {{"variant", "polar"}}), direct, "transmittance") <= 1.2e-4);
      // A depth that is off by the tolerance moves the transmittance by at most as much.
      for (const std::string tolerance : {"0.3", "0.01"})
        CHECK(most(picture(method, scene, {{"variant", "bound"}, {"tolerance", tolerance}}), direct, "transmittance") <=
              std::stod(tolerance));
      const scene::Film paper = picture(method, scene, {{"variant", "paper"}, {"mu", "0.4"}});
      CHECK(most(picture(method, scene, {{"variant", "tele"}, {"mu", "0.4"}}), paper, "transmittance") <= 2e-7);
      CHECK(most(picture(method, scene, {{"variant", "paper"}, {"mu", "1"}}), direct, "transmittance") <= 2e-7);
    }
}

// The table begins at the map's rim, and turns over what the map takes: from the eye it took 733 MB at 20 km. Seen from
// one side, edges of a hard map need more angles than from within.
TEST_CASE("wavelet fog: polar from an eye far away is as close, and its table no larger", "[wavelet_fog]") {
  struct Far {
    Point3 eye;
    double fov;
  };
  const Far eyes[] = {{{-2e4, 900, -1.2e4}, 0.004},
                      {{-2e4, 900, -1.2e4}, 0.8},
                      {{1e5, 3000, 0}, 0.0012},
                      {{300, 20, -5}, 0.3},
                      {{0, 2000, 300}, 2.5}};
  for (const std::string name : {"smooth", "patchy", "hard"})
    for (const Far& far : eyes) {
      const auto scene = seen_from(scene_named("wavelet_fog/" + name, 48, 36), far.eye, {0, 0, 0});
      scene->camera.vertical_fov = far.fov;
      CAPTURE(name, far.eye.transpose());
      const scene::Film direct = picture(method, scene, {{"variant", "direct"}});
      CHECK(rms(picture(method, scene, {{"variant", "polar"}, {"angles", "2048"}}), direct, "transmittance") <= 1.2e-4);
      const auto& fog = *std::get<scene::FogmapPointer>(scene->media[0].field);
      const scene::MapLine at = line_over(fog, {far.eye, Vec3::UnitX()});
      const double across =
          std::hypot(fog.map.support_hi(0) - fog.map.support_lo(0), fog.map.support_hi(1) - fog.map.support_lo(1));
      CHECK(wavelet_fog::spoke_of(fog.map, at.u, at.v, 512, 0.5).steps <= 2 * across + 4);
    }
  const auto scene = scene_named("wavelet_fog/patchy", 8, 6);
  CHECK_THROWS_WITH(picture(method, scene, {{"variant", "polar"}, {"angles", "65536"}, {"radial_step", "0.001"}}),
                    Catch::Contains("variant = polar: a table of") && Catch::Contains("radial_step"));
}

TEST_CASE("wavelet fog: a ray that ends early is off by the threshold at most", "[wavelet_fog]") {
  const auto scene = scene_named("wavelet_fog/patchy", 96, 72);
  scene->media[0].sigma_t *= 20;
  const scene::Film direct = picture(method, scene, {{"variant", "direct"}});
  const scene::Rendering all = render(method, scene, {{"variant", "skip"}});
  const scene::Rendering ended = render(method, scene, {{"variant", "skip"}, {"termination", "0.02"}});
  CHECK(most(ended.film, direct, "transmittance") <= 0.02);
  CHECK(ended.counters.at("cells") < 0.8 * all.counters.at("cells"));
}

TEST_CASE("wavelet fog: every layer is that of the deterministic reference", "[wavelet_fog]") {
  const auto scene = scene_named("wavelet_fog/valley", 48, 36);
  const scene::Film film = picture(method, scene);
  const scene::Film truth = picture(*deterministic::make_renderer(), scene);
  for (const char* layer : {"transmittance", "ambient", "surface"}) {
    CAPTURE(layer);
    CHECK(relative_l2(film, truth, layer) <= 1e-7);
  }
}

TEST_CASE("one fog as a map and as a sum of Gaussians", "[wavelet_fog][fogmap]") {
  // Densities up to 0.84. The map's layers are at most (0.15 m)^2 / 8 of the height's curvature, 2 / (6 m)^2, above the
  // Gaussian, 1.6e-4 of it; a dot blurred and spread by a cubic spline is one of the same variance, but for its fourth
  // cumulant, 3e-5 of it.
  const auto map = scene_named("wavelet_fog/gaussian_map", 48, 36),
             sum = scene_named("wavelet_fog/gaussian_sum", 48, 36);
  double greatest = 0;
  for (double x = -30; x < 30; x += 1.37)
    for (double y = -20; y < 25; y += 0.83)
      for (double z = -30; z < 30; z += 1.91) {
        const double density = scene::density(sum->media[0], {x, y, z});
        REQUIRE(std::abs(scene::density(map->media[0], {x, y, z}) - density) <= 2e-4);
        greatest = std::max(greatest, density);
      }
  CHECK(greatest > 0.75);
  const auto truth = deterministic::make_renderer();
  const scene::Film a = picture(*truth, map), b = picture(*truth, sum);
  CHECK(rms(a, b, "transmittance") <= 6e-5);
  CHECK(rms(picture(method, map), b, "transmittance") <= 6e-5);
  CHECK(rms(picture(fogshop::Fogshop(), sum), a, "transmittance") <= 1e-4);
}

TEST_CASE("references agree on light scattered in a fogmap", "[fogmap][path_tracer]") {
  // Two tests of equality with a false alarm in 1e-4 each.
  for (const Point3& eye : {Point3(-12, 2, -22), Point3(-60, 9, -45)}) {
    const auto scene = seen_from(scene_named("wavelet_fog/patchy", 24, 18), eye, {3, 1.5, 8});
    scene->ambient_in_scatter = Rgb::Zero();
    scene->lights = {scene::PointLight{{2, 3, 4}, Rgb(900, 700, 500), 0}};
    const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-6"}}, 0);
    const scene::Film traced = picture(path_tracer::PathTracer(), scene, {{"samples", "2048"}, {"max_order", "1"}}, 0);
    CAPTURE(eye.transpose());
    CHECK(experiments::compare_equal(traced, truth, "mean", {}, 1e-4).equal);
    const scene::Film marched =
        picture(ray_marcher::RayMarcher(), scene, {{"steps", "256"}, {"shadow_steps", "256"}}, 0);
    CHECK(relative_l2(marched, truth, "airlight") <= 2e-3);
  }
}

}  // namespace variants_test
