// Environment light in Fogshop: Eqs. 26 to 28 of Zhou et al. 2007 against quadrature and closed forms.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/environment_lighting.h"
#include "methods/fogshop/harmonic_reflection.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/methods/fogshop/sky.h"

namespace environment_test {

using namespace airlight;
using namespace airlight::fogshop;
using namespace airlight::fogshop::test;

namespace {

// Integral over the sphere of f(w) in spherical coordinates around an axis, gamma = pi x^2, which takes away 1/gamma.
template <class F>
Rgb around(const Vec3& axis, F f) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(64);
  const Vec3 a = axis.unitOrthogonal(), b = axis.cross(a);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double x = 0.5 * (1 + rule.node[i]), gamma = pi * x * x;
    const double ring = 0.5 * rule.weight[i] * 2 * pi * x * std::sin(gamma) * 2 * pi / 48;
    for (int k = 0; k < 48; ++k) {
      const double phi = 2 * pi * (k + 0.5) / 48;
      sum += ring * f(std::cos(gamma) * axis + std::sin(gamma) * (std::cos(phi) * a + std::sin(phi) * b), gamma);
    }
  }
  return sum;
}

}  // namespace

// The specification's statement of energy: e^-T (1 + 1.17979 T) under a uniform sky, above 1 up to T = 0.322, at most
// 1.0130 at T = 0.152.
TEST_CASE("a uniform sky through the printed NPSF", "[fogshop]") {
  const double k = std::sqrt(4 * pi) * npsf_coefficient(0, 1);
  CHECK(std::abs(k - 1.17979) < 5e-6);
  const auto seen = [&](double T) { return std::exp(-T) * (1 + k * T); };
  CHECK(std::abs(seen(0.152) - 1.0130) < 5e-5);
  CHECK((seen(0.152) > seen(0.151) && seen(0.152) > seen(0.154)));
  CHECK((seen(0.3215) > 1 && seen(0.3225) < 1));

  Scene scene = gaussians_under(scene::make_constant_environment(Rgb(1, 2, 3)));
  scene.media[0].sigma_t = Rgb(1, 0.5, 0.25);
  for (const char* order : {"1", "6"}) {
    const Film film = render(scene, {{"environment_psf", "npsf"}, {"sh_order", order}, {"eps_T", "1e-12"}}).film;
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const Rgb visible = transmittance(scene.media, pixel_ray(scene, x, y), {0, infinity});
        const Rgb expected = Rgb(1, 2, 3) * visible * (1 - k * visible.log());
        CHECK(((film.get("mean", x, y) - expected).abs() <= 2e-6 * expected).all());
        CHECK(((film.get("surface", x, y) - Rgb(1, 2, 3) * visible).abs() <= 2e-6 * expected).all());
      }
  }
}

TEST_CASE("airlight of the sky is its convolution with the PSF", "[fogshop]") {
  Scene scene = gaussians_under(sky_light());
  scene.media[0].sigma_t = Rgb(1, 0.6, 0.3);
  scene.media[0].albedo = Rgb(0.9, 0.8, 0.7);
  const std::vector<Rgb> coefficients = sky();
  for (const char* psf : {"npsf", "npsfT", "ball"}) {
    const std::string name = psf;
    const Film film = render(scene, {{"environment_psf", name}, {"eps_T", "1e-12"}, {"variant", "paper"}}).film;
    for (const auto& [x, y] : {std::pair(0, 1), std::pair(3, 2), std::pair(5, 0)}) {
      const Ray ray = pixel_ray(scene, x, y);
      const Rgb T = -transmittance(scene.media, ray, {0, infinity}).log();
      const Rgb sum = around(ray.direction, [&](const Vec3& w, double gamma) {
        const Rgb light = scene::evaluate_sh(coefficients, w);
        Rgb spread;
        for (int c = 0; c < 3; ++c)
          spread[c] = name == "ball" ? ball_psf(gamma, T[c]) : npsf(gamma, name == "npsf" ? 1 : T[c]);
        return Rgb(light * spread);
      });
      const Rgb expected = sum * T * (-T).exp() * scene.media[0].albedo;
      CAPTURE(name, x, y, expected);
      // The printed NPSF has no table; the others' is linear between 64 depths.
      CHECK(((film.get("airlight", x, y) - expected).abs() <= (name == "npsf" ? 2e-6 : 2e-3) * expected).all());
    }
  }
}

TEST_CASE("the PSF of a ball: limits and coefficients", "[fogshop]") {
  for (const double T : {1e-6, 0.1, 1.0, 8.0, 30.0}) {
    CHECK(ball_psf(0, T) * 4 * pi == Approx(1).epsilon(1e-7));
    CHECK(ball_psf(pi, T) * 4 * pi == Approx(-std::expm1(-2 * T) / (2 * T)).epsilon(1e-7));
    for (const double gamma : {0.3, 1.0, 1.57, 2.5}) {
      CHECK(ball_psf(gamma, T) <= ball_psf(0, T) * (1 + 1e-7));
      // The plain integral, by many midpoints of t = T sin x.
      double sum = 0;
      constexpr int n = 200000;
      for (int i = 0; i < n; ++i) {
        const double x = 0.5 * pi * (i + 0.5) / n, t = T * std::sin(x);
        const double s = std::sqrt(T * T - std::pow(t * std::sin(gamma), 2)) - t * std::cos(gamma);
        sum += 0.5 * pi / n * std::cos(x) * std::exp(T - t - s);
      }
      CHECK(ball_psf(gamma, T) * 4 * pi == Approx(sum).epsilon(1e-7));
    }
  }
  // A thin ball scatters every light evenly.
  CHECK(ball_psf_coefficient(0, 1e-9) == Approx(1 / std::sqrt(4 * pi)).epsilon(1e-7));
  for (int l = 1; l < 12; ++l) CHECK(std::abs(ball_psf_coefficient(l, 1e-9)) < 1e-8);
  const PsfBands bands(Psf::ball, 6);
  for (const double T : {0.002, 0.7, 3.3, 25.0})
    for (int l = 0; l < 6; ++l)
      CHECK(std::abs(bands(T)[l] - ball_psf_coefficient(l, T)) < 2e-3 * ball_psf_coefficient(0, T));
}

TEST_CASE("average depth around a point", "[fogshop]") {
  const Scene scene = gaussians_under(sky_light());
  const Model model =
      make_model(scene, read_options(scene::Settings(method.settings(), {{"environment_distance", "50"}})));
  for (const Point3& p : {Point3(0, 0, -3), Point3(2, -1, -4), Point3(0.5, 0.2, -4), Point3(-6, 3, 2)}) {
    const Rgb mean =
        around(Vec3(0.5, 0.2, -4) - p == Vec3::Zero() ? Vec3(0, 0, 1) : (Vec3(0.5, 0.2, -4) - p).normalized(),
               [&](const Vec3& w, double) {
                 return Rgb(-transmittance(scene.media, {p, w}, {0, infinity}).log() / (4 * pi));
               });
    CHECK(average_depth(model, p) == Approx(mean[0]).epsilon(1e-5));
  }
  Scene constant = scene;
  std::get<scene::GaussianSum>(constant.media[0].field).constant = 0.1;
  const Model fog =
      make_model(constant, read_options(scene::Settings(method.settings(), {{"environment_distance", "50"}})));
  CHECK(average_depth(fog, Point3(0, 0, -3)) == Approx(average_depth(model, Point3(0, 0, -3)) + 5).epsilon(1e-12));
}

TEST_CASE("the tree of average depths is made where it is read", "[fogshop]") {
  Scene scene = gaussians_under(sky_light());
  scene.surfaces.push_back({"floor", scene::Plane{Point3(0, -1, 0), Vec3::UnitY()}, scene::Lambert{}});
  auto& gaussians = std::get<scene::GaussianSum>(scene.media[0].field).gaussians;
  finish(scene);
  const char* stage = "tree of average depths";
  CHECK_FALSE(kept(scene, stage));  // three Gaussians
  while (gaussians.size() < 30) gaussians.push_back({Point3(0.1 * double(gaussians.size()), 0, -3), 0.3, 0.1});
  finish(scene);
  CHECK(kept(scene, stage));
  CHECK_FALSE(kept(scene, stage, {{"average_depth", "exact"}}));
  CHECK_FALSE(kept(scene, stage, {{"eps_T", "1e-7"}}));
  const Film tree = render(scene).film, exact = render(scene, {{"average_depth", "exact"}}).film;
  CHECK(tree.layer("surface") != exact.layer("surface"));
  CHECK(airlight::test::relative_l2(tree, exact, "surface") < 1e-5);
  scene.lights = {scene::PointLight{Point3(0, 1, -2), Rgb::Ones(), 0}};
  finish(scene);
  CHECK_FALSE(kept(scene, stage));
  scene.lights = {sky_light()};
  scene.surfaces.clear();
  finish(scene);
  CHECK_FALSE(kept(scene, stage));
}

TEST_CASE("harmonics reflected by Lambert and Phong", "[fogshop]") {
  const Vec3 normal = Vec3(0.2, 1, 0.3).normalized();
  const std::vector<Rgb> light = sky();
  const scene::GaussLegendre rule = scene::gauss_legendre(400);
  const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
  const auto exact = [&](const scene::Material& material, const Vec3& to_view) {
    Rgb sum = Rgb::Zero();
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double c = 0.5 * (1 + rule.node[i]), s = std::sqrt(1 - c * c);
      for (int k = 0; k < 720; ++k) {
        const double phi = 2 * pi * (k + 0.5) / 720;
        const Vec3 in = c * normal + s * (std::cos(phi) * a + std::sin(phi) * b);
        sum += 0.5 * rule.weight[i] * (2 * pi / 720) * c * scene::brdf(material, normal, in, to_view) *
               scene::evaluate_sh(light, in);
      }
    }
    return sum;
  };
  const auto reflect = [&](const scene::Material& material, const Vec3& to_view) {
    return reflect_harmonics(reflectance_harmonics(material, normal, to_view, int(std::sqrt(light.size()))), light);
  };
  for (const Vec3& to_view : {normal, Vec3(Vec3(1, 1, 0).normalized()), Vec3(Vec3(1, 0, 0.2).normalized())}) {
    const scene::Material lambert = scene::Lambert{Rgb(0.8, 0.5, 0.2)};
    const Rgb got = reflect(lambert, to_view);
    CHECK(((got - exact(lambert, to_view)).abs() < 1e-9 * got).all());
    for (const double exponent : {0.0, 5.0, 40.0}) {
      const scene::Material phong = scene::Phong{Rgb::Constant(0.2), Rgb(0.5, 0.3, 0.1), exponent};
      const Rgb expected = exact(phong, to_view);
      CAPTURE(to_view.transpose(), exponent, expected);
      // The horizon cuts the lobe between directions.
      CHECK(((reflect(phong, to_view) - expected).abs() < 5e-3 * expected).all());
    }
    CHECK(reflect(lambert, -to_view).isZero());
  }
}

// Eq. 27 through Eq. 29 on a floor, from its parts by quadrature.
TEST_CASE("a floor under the sky in Gaussian fog", "[fogshop]") {
  Scene scene = gaussians_under(sky_light());
  scene.media[0].sigma_t = Rgb(1, 0.6, 0.3);
  scene.media[0].albedo = Rgb::Constant(0.9);
  scene.surfaces.push_back(
      {"floor", scene::Plane{Point3(0, -1, 0), Vec3(0, 1, 0)}, scene::Lambert{Rgb(0.5, 0.6, 0.7)}});
  finish(scene);
  const Pairs given{{"environment_psf", "npsf"}, {"reflectance", "npsf"}, {"eps_T", "1e-12"}};
  const Film film = render(scene, given).film;
  const std::vector<Rgb> light = sky();
  std::vector<Rgb> spread = light;
  for (int l = 0; l < 4; ++l)
    for (int j = l * l; j < (l + 1) * (l + 1); ++j)
      spread[j] *= std::sqrt(4 * pi / (2 * l + 1)) * npsf_coefficient(l, 1);
  const scene::GaussLegendre rule = scene::gauss_legendre(64);
  for (int x = 0; x < scene.width; ++x) {
    const int y = scene.height - 1;
    const Ray ray = pixel_ray(scene, x, y);
    const double t = -1 / ray.direction.y();
    const Rgb mean = around(Vec3(0, 1, 0), [&](const Vec3& w, double) {
      return Rgb(-transmittance(scene.media, {ray.at(t), w}, {0, infinity}).log() / (4 * pi));
    });
    Rgb direct = Rgb::Zero(), scattered = Rgb::Zero();
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double c = 0.5 * (1 + rule.node[i]), s = std::sqrt(1 - c * c);
      for (int k = 0; k < 64; ++k) {
        const Vec3 in(s * std::cos(2 * pi * k / 64), c, s * std::sin(2 * pi * k / 64));
        const double weight = 0.5 * rule.weight[i] * 2 * pi / 64 * c / pi;
        direct += weight * scene::evaluate_sh(light, in);
        scattered += weight * scene::evaluate_sh(spread, in);
      }
    }
    const Rgb visible = transmittance(scene.media, ray, {0, t}) * Rgb(0.5, 0.6, 0.7);
    const Rgb expected = visible * 0.9 * mean * (-mean).exp() * scattered;
    CAPTURE(x, expected, film.get("reflected_airlight", x, y));
    CHECK(((film.get("reflected_airlight", x, y) - expected).abs() < 1e-4 * expected).all());
    CHECK(((film.get("surface", x, y) - expected - visible * (-mean).exp() * direct).abs() < 1e-3 * expected).all());
    CHECK(film.get("airlight", x, y).isZero());
  }
}

TEST_CASE("environment stages are there with an environment alone", "[fogshop]") {
  Scene scene = gaussians_under(sky_light());
  const char* stages[] = {"background", "harmonics of the environment", "airlight of the environment"};
  for (const char* stage : stages) CHECK(kept(scene, stage));
  CHECK_FALSE(kept(scene, "light maps"));
  CHECK_FALSE(kept(scene, "airlight of Gaussians"));
  CHECK_FALSE(kept(scene, "depths to centres", {{"variant", "paper"}}));
  CHECK_FALSE(kept(scene, "environment on surfaces"));
  const scene::Rendering alone = render(scene);
  // The depth of every ray, and nothing else: two error functions for each Gaussian that it crosses.
  CHECK(alone.counters.at("erf_evaluations") == 2 * alone.counters.at("gaussians_crossed"));
  CHECK(alone.counters.at("erf_evaluations_prepare") == 0);

  Scene clear = scene;
  clear.media.clear();
  CHECK(kept(clear, "background"));
  CHECK_FALSE(kept(clear, "harmonics of the environment"));
  CHECK(((render(clear).film.get("mean", 2, 2) - radiance(sky_light(), pixel_ray(clear, 2, 2).direction)).abs() < 1e-6)
            .all());

  // An endless constant lets nothing through, until the environment has a distance.
  Scene constant = scene;
  std::get<scene::GaussianSum>(constant.media[0].field).constant = 0.01;
  for (const char* stage : stages) {
    CHECK_FALSE(kept(constant, stage));
    CHECK(kept(constant, stage, {{"environment_distance", "30"}}));
  }
  CHECK(render(constant).film.get("mean", 2, 2).isZero());
  const Film near = render(constant, {{"environment_distance", "30"}}).film;
  const Rgb visible = transmittance(constant.media, pixel_ray(constant, 2, 2), {0, 30});
  CHECK(((near.get("transmittance", 2, 2) - visible).abs() < 1e-5).all());
  CHECK((near.get("airlight", 2, 2) > 0).all());

  Scene points = scene;
  points.lights.clear();
  points.lights.push_back(scene::PointLight{Point3(1, 2, -3), Rgb(3, 2, 1), 0});
  for (const char* stage : stages) CHECK_FALSE(kept(points, stage));
  Scene dark = scene;
  dark.lights.clear();
  dark.lights.push_back(scene::make_constant_environment(Rgb::Zero()));
  for (const char* stage : stages) CHECK_FALSE(kept(dark, stage));
}

TEST_CASE("point lights and environments add, on any number of threads", "[fogshop]") {
  Scene both = gaussians_under(sky_light());
  both.lights.push_back(scene::PointLight{Point3(1, 2, -3), Rgb(3, 2, 1), 0.1});
  both.surfaces.push_back({"floor", scene::Plane{Point3(0, -1, 0), Vec3(0, 1, 0)},
                           scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.4), 5}});
  finish(both);
  Scene points = both, skies = both;
  points.lights.clear();
  points.lights.push_back(both.lights[1]);
  skies.lights.pop_back();
  for (const char* variant : {"paper", "S"}) {
    const Pairs given{{"variant", variant}, {"reflectance", "npsfT"}};
    const Film all = render(both, given).film, point = render(points, given).film, sky = render(skies, given).film;
    CHECK(all.layers == render(both, given, 2).film.layers);
    for (const char* layer : {"airlight", "surface", "reflected_airlight"})
      for (int y = 0; y < both.height; ++y)
        for (int x = 0; x < both.width; ++x) {
          // The light's ball ends rays only where the light is.
          if (sky.get("transmittance", x, y)[0] != point.get("transmittance", x, y)[0]) continue;
          const Rgb sum = point.get(layer, x, y) + sky.get(layer, x, y);
          CHECK(((all.get(layer, x, y) - sum).abs() <= 1e-6 * sum).all());
        }
  }
}

}  // namespace environment_test
