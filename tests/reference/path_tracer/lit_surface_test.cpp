// Paths that end on the light of a surface (setting `paths`): against quadrature, and against all paths.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/surface_psf.h"
#include "scene/math/gauss_legendre.h"
#include "tests/reference/path_tracer/scenes.h"

namespace lit_surface_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

const Vec3 up(0, 1, 0);

RadianceEstimate estimate(const std::shared_ptr<const scene::Scene>& scene, const Ray& ray, Options::Paths paths,
                          std::uint64_t samples, int max_order = -1) {
  Options options;
  options.paths = paths;
  options.max_order = max_order;
  return radiance(World(scene, options), ray, samples, {}, 7);
}

bool agree(const Estimate& got, const Rgb& expected, double z) {
  return ((got.mean - expected).abs() <= z * got.error).all() && (got.error > 0).all();
}

}  // namespace

// A floor in constant coloured fog, which receives I/d^2 T e^-T NPSF_T(gamma) from every direction above it.
TEST_CASE("light scattered once on its way to a floor is the quadrature's", "[path_tracer]") {
  const Point3 light(1, 2, 0.5);
  const Rgb sigma(0.5, 0.3, 0.1);
  for (const scene::Material& material : {scene::Material(scene::Lambert{Rgb::Constant(0.8)}),
                                          scene::Material(scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.5), 12})}) {
    scene::Medium fog = medium(scene::Unbounded{}, 1, 0.9);
    fog.sigma_t = sigma;
    const auto world = scene_of({fog}, {scene::PointLight{light, Rgb::Constant(3), 0}},
                                {{"floor", scene::Plane{Point3::Zero(), up}, material}});
    const Ray ray = ray_of({0, 1, 2}, {0, -1, -2});
    const Vec3 to_view = -ray.direction, offset = light;  // the ray meets the floor at the origin
    const double distance = offset.norm(), seen = std::sqrt(5.0);
    const Vec3 to_light = offset / distance, a = to_light.unitOrthogonal(), b = to_light.cross(a);
    const scene::GaussLegendre rule = scene::gauss_legendre(128);
    Rgb once = Rgb::Zero();
    for (int c = 0; c < 3; ++c) {
      const double T = sigma[c] * distance;
      for (int i = 0; i < 128; ++i)
        for (int k = 0; k < 512; ++k) {
          const double x = 0.5 * (1 + rule.node[i]), gamma = pi * x * x, phi = 2 * pi * (k + 0.5) / 512;
          const Vec3 in = std::cos(gamma) * to_light + std::sin(gamma) * (std::cos(phi) * a + std::sin(phi) * b);
          once[c] += 0.5 * rule.weight[i] * 2 * pi * x * std::sin(gamma) * 2 * pi / 512 * fogshop::npsf(gamma, T) *
                     std::max(0.0, up.dot(in)) * scene::brdf(material, up, in, to_view)[c];
        }
      once[c] *= 0.9 * 3 / (distance * distance) * T * std::exp(-T - sigma[c] * seen);
    }
    const Rgb direct = scene::brdf(material, up, to_light, to_view) * up.dot(to_light) * 3 / (distance * distance) *
                       (-sigma * (distance + seen)).exp();
    const std::uint64_t samples = 1 << 17;
    const RadianceEstimate scattered = estimate(world, ray, Options::Paths::scattered_to_surface, samples);
    const RadianceEstimate lit = estimate(world, ray, Options::Paths::lit_surface, samples);
    // Two materials, two estimates, three channels; 1e-6 false alarms.
    const double z = threshold(1e-6, 12);
    CAPTURE(once, direct, scattered.total.mean, scattered.total.error, lit.total.mean);
    CHECK(agree(scattered.total, once, z));
    CHECK(agree(lit.total, once + direct, z));
    CHECK((scattered.total.error < 0.01 * once).all());
    CHECK((scattered.orders[0].mean == 0).all());
    CHECK(((lit.orders[0].mean - direct).abs() < 1e-10).all());  // without noise: one light
  }
}

// All paths of order (1, s): a (1, 1) part that is in proportion to the albedo, and (1, 2) to its square. The camera
// ray misses the medium, so that (1, 1) is the light of the surface alone; two albedos separate the parts.
TEST_CASE("an environment scattered once on its way to a floor", "[path_tracer]") {
  const auto scene_with = [](double albedo) {
    return scene_of({medium(scene::Sphere{Point3(0, 1.2, 0), 0.8}, 1.5, 0.7)}, {white()},
                    {{"floor", scene::Plane{Point3::Zero(), up}, scene::Lambert{Rgb::Constant(albedo)}}});
  };
  const Ray ray = ray_of({0.2, 0.3, 2.5}, {0, -0.3, -2.5});
  const std::uint64_t samples = 1 << 19;
  const Estimate some = estimate(scene_with(0.4), ray, Options::Paths::all, samples, 1).orders[1];
  const Estimate more = estimate(scene_with(0.8), ray, Options::Paths::all, samples, 1).orders[1];
  const double expected = (4 * some.mean[0] - more.mean[0]) / 2;  // at albedo 0.4
  const double error = std::hypot(4 * some.error[0], more.error[0]) / 2;
  const RadianceEstimate got = estimate(scene_with(0.4), ray, Options::Paths::lit_surface, samples);
  const Estimate once = estimate(scene_with(0.4), ray, Options::Paths::scattered_to_surface, samples).total;
  const double z = threshold(1e-6, 3);
  CAPTURE(expected, error, got.orders[1].mean[0], once.mean[0]);
  CHECK(error < 0.02 * expected);
  CHECK(std::abs(got.orders[1].mean[0] - expected) < z * std::hypot(error, got.orders[1].error[0]));
  CHECK(std::abs(once.mean[0] - expected) < z * std::hypot(error, once.error[0]));
  const Estimate unscattered = estimate(scene_with(0.4), ray, Options::Paths::all, samples, 0).orders[0];
  CHECK(std::abs(got.orders[0].mean[0] - unscattered.mean[0]) <
        z * std::hypot(unscattered.error[0], got.orders[0].error[0]));
}

// A Gaussian of fog above a floor, the light outside of it: the volume integral of density / (4 pi) * I / |x - light|^2
// * albedo / pi * cosine / |x - p|^2 and the transmittances of both ways, in spherical coordinates about the floor's
// point, which take the last square away.
TEST_CASE("a Gaussian scatters light onto a floor", "[path_tracer]") {
  const Point3 light(2.5, 2.5, 0.4), center(0.5, 1, 0);
  const double width = 0.4, amplitude = 1.5;
  scene::Medium fog = medium(scene::Unbounded{}, 1, 1);
  scene::GaussianSum sum;
  sum.gaussians = {{center, width, amplitude}};
  fog.field = sum;
  const auto world = scene_of({fog}, {scene::PointLight{light, Rgb::Constant(3), 0}},
                              {{"floor", scene::Plane{Point3::Zero(), up}, scene::Lambert{Rgb::Constant(0.8)}}});
  const auto depth = [&](const Point3& a, const Point3& b) {
    const double length = (b - a).norm();
    return scene::density_integral(fog, {a, (b - a) / length}, {0, length});
  };
  const int n = 48;
  const scene::GaussLegendre rule = scene::gauss_legendre(n);
  double expected = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < 2 * n; ++k) {
        const double r = 1.5 * (1 + rule.node[i]), c = 0.5 * (1 + rule.node[j]), s = std::sqrt((1 - c) * (1 + c));
        const double phi = pi * k / n;
        const Point3 x = r * Vec3(s * std::cos(phi), c, s * std::sin(phi));
        const double density = amplitude * std::exp(-(x - center).squaredNorm() / (width * width));
        expected += 1.5 * rule.weight[i] * 0.5 * rule.weight[j] * pi / n * density / (4 * pi) * 3 /
                    (x - light).squaredNorm() * 0.8 / pi * c * std::exp(-depth(x, light) - depth(x, Point3::Zero()));
      }
  const Point3 eye(-2, 1, 2);
  expected *= std::exp(-depth(eye, Point3::Zero()));
  const Estimate got = estimate(world, ray_of(eye, -eye), Options::Paths::scattered_to_surface, 1 << 18).total;
  CAPTURE(expected, got.mean[0], got.error[0]);
  CHECK(got.error[0] < 0.01 * expected);
  CHECK(std::abs(got.mean[0] - expected) < threshold(1e-6, 1) * got.error[0]);
}

}  // namespace lit_surface_test
