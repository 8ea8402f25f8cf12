// Stress cases 6 to 9: rooms without absorption, media without scattering, extreme phase functions.
#include "scene/geometry/shapes.h"
#include "scene/math/gauss_legendre.h"
#include "tests/stress/stress.h"

namespace scattering_test {

using namespace airlight;
using namespace airlight::stress;

TEST_CASE("stress 06: a closed white room with a light in it has no finite answer", "[stress]") {
  const auto room = [](double albedo, bool open) {
    scene::TriangleMesh mesh = scene::make_box({{-1, -1, -1}, {1, 1, 1}});
    if (open) mesh.triangles.resize(10);
    auto s = scene_of({medium(Box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, 1, 1)}, {scene::PointLight{{0, 0.8, 0}}},
                      {{"room", mesh, scene::Lambert{Rgb::Constant(albedo)}}});
    s->camera = scene::look_at({0, 0, 0.9}, {0, 0, 0}, Vec3::UnitY());
    return s;
  };
  const auto reasons = stress::refusals("path_tracer", *room(1, false));
  REQUIRE(reasons.size() == 1);
  CHECK_THAT(reasons.front(), Catch::Contains("closed room") && Catch::Contains("no finite answer"));
  CHECK(stress::refusals("path_tracer", *room(0.9, false)).empty());
  CHECK(stress::refusals("path_tracer", *room(1, true)).empty());
  const auto lit = room(0.9, false);
  const scene::Film film = picture("path_tracer", lit, {lit->camera, 4, 4}, {{"samples", "64"}});
  CHECK(all_finite(film));
}

TEST_CASE("stress 07: albedo 0 scatters exactly nothing", "[stress]") {
  const std::vector<scene::Light> lights = {white(), scene::PointLight{{0.2, 0.1, 0}}, scene::SpotLight{{0, 0.9, 0}},
                                            scene::DirectionalLight{}};
  scene::GaussianSum sum;
  sum.gaussians = {{{0.2, 0, 0}, 0.5, 2}};
  const auto scene = scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 2, 0), of_field(sum, 1, 0)}, lights);
  const auto view = view_from({0.3, 0.2, -3}, {0, 0, 0}, 9);
  for (const char* const name : renderers) {
    const scene::Film film = picture(name, scene, view);
    CAPTURE(name);
    CHECK(all_finite(film));
    int scattered = 0;
    for (const auto& [layer, values] : film.layers)
      if (layer == "airlight" || layer == "order.rest" || (layer.rfind("order.", 0) == 0 && layer != "order.0"))
        for (const float v : values) scattered += v != 0;
    CHECK(scattered == 0);
    CHECK(film.get("transmittance", 4, 4)[0] < 0.1);
  }
}

TEST_CASE("stress 08: g = 0.999 and -0.999, tau 5", "[stress]") {
  int index = 0;
  for (const double g : {0.999, -0.999}) {
    const scene::PhaseFunction phase = scene::HenyeyGreenstein{g};
    // Between the cosines of two uniforms lies the share of the sphere that they say: normalised, and sampled as it is
    // evaluated. p is analytic with its nearest pole (1 + g^2) / 2g = 1 + 5e-7; the intervals are as wide as their
    // distance from it, so that 32 Gauss points are exact to rounding.
    const int n = 64;
    double sum = 0, last = -1;
    const auto rule = scene::gauss_legendre(32);
    for (int i = 1; i <= n; ++i) {
      const double u = double(i) / n, c = scene::sample_phase_cosine(phase, u);
      CHECK((c >= -1 && c <= 1 && c >= last));
      // Substitution by the distance from the pole on a logarithmic scale.
      const double pole = (1 + g * g) / (2 * g), from = std::log(std::abs(pole - last)),
                   to = std::log(std::abs(pole - c));
      double share = 0;
      for (int k = 0; k < 32; ++k) {
        const double x = 0.5 * (from + to) + 0.5 * (to - from) * rule.node[k], distance = std::exp(x);
        // |1 + g^2 - 2 g c| = 2 |g| distance, without the cancellation of going through c.
        share += 0.5 * std::abs(to - from) * rule.weight[k] * distance * 0.5 * (1 - g * g) /
                 std::pow(2 * std::abs(g) * distance, 1.5);
      }
      CHECK(share == Approx(1.0 / n).epsilon(1e-6));
      sum += share;
      last = c;
    }
    CHECK(sum == Approx(1).epsilon(1e-9));
    // The peak: 1 + g^2 - 2 g c = 1e-6 out of three roundings of numbers up to 2, 2e-16 each, to the power 3/2.
    CHECK(2 * pi * scene::phase_value(phase, g > 0 ? 1 : -1) ==
          Approx(0.5 * (1 + std::abs(g)) / std::pow(1 - std::abs(g), 2)).epsilon(1e-9));
    // The furnace.
    const World world(scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 5, 1, phase)}, {white()}), Options{});
    const auto e = radiance(world, ray_of({0.1, 0.2, -3}, {0, 0, 1}), 1 << 14, {}, 80 + ++index);
    check_equal(1, e.total, 0.02);
    CHECK(e.orders[0].mean[0] < 0.01);
  }
}

// p = (1 + 3 g c) / (4 pi) up to 5 g^2.
TEST_CASE("stress 09: g = 1e-12 and 1e-5 are isotropic within 3 g", "[stress]") {
  const auto scene_with = [](const scene::PhaseFunction& phase) {
    return scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 2, 0.9, phase)},
                    {scene::PointLight{{0.5, 0.4, 0.1}}, scene::DirectionalLight{}});
  };
  const Ray ray = ray_of({0.1, 0.2, -3}, {0, 0, 1});
  const double isotropic = deterministic::airlight(*scene_with(scene::Isotropic{}), ray, infinity).radiance[0];
  Options options;
  for (const double g : {1e-12, 1e-5, -1e-12, -1e-5}) {
    const double within = 3 * std::abs(g) * (1 + 2 * std::abs(g));
    for (const double c : {-1.0, -0.3, 0.0, 0.7, 1.0})
      CHECK(std::abs(4 * pi * scene::phase_value(scene::HenyeyGreenstein{g}, c) - 1) <= within + 1e-15);
    // The cosine of u moves by 3/2 g (1 - x^2), x = 2 u - 1.
    for (const double u : {0.0, 0.1, 0.5, 0.9, 1.0})
      CHECK(std::abs(scene::sample_phase_cosine(scene::HenyeyGreenstein{g}, u) - (2 * u - 1)) <=
            1.5 * std::abs(g) * (1 + 3 * std::abs(g)) + 1e-15);
    const auto scene = scene_with(scene::HenyeyGreenstein{g});
    // Both integrals are good to 1e-10 of themselves.
    CHECK(std::abs(deterministic::airlight(*scene, ray, infinity).radiance[0] / isotropic - 1) <= within + 2e-10);
    // Equal random numbers make nearly equal paths: the only difference between them is what g itself changes.
    const auto a = radiance(World(scene, options), ray, 4096, {}, 91);
    const auto b = radiance(World(scene_with(scene::Isotropic{}), options), ray, 4096, {}, 91);
    check_equal(isotropic, a.orders[1], 0.05);
    check_equal(b.total.mean[0], a.total.mean[0], std::hypot(a.total.error[0], b.total.error[0]), 0.1);
  }
}

}  // namespace scattering_test
