// The adaptive quadrature against a plain midpoint sum over the definition, which shares nothing with it but the
// scene's own functions.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "scene/media/voxel_grid.h"

namespace brute_force_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

Rgb midpoint_sum(const Scene& s, const Ray& ray, Interval range, int steps) {
  Rgb sum = Rgb::Zero();
  const double dt = range.length() / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = range.lo + (i + 0.5) * dt;
    const Point3 x = ray.at(t);
    if (!(extinction(s.media, x).maxCoeff() > 0)) continue;
    const Rgb view = transmittance(s.media, ray, {0, t});
    for (const Light& light : s.lights) {
      const Incident in = incident(light, x);
      Rgb source = Rgb::Zero();
      for (const Medium& m : s.media)
        source += m.albedo * m.sigma_t * density(m, x) * phase_value(m.phase, in.to_light.dot(ray.direction));
      sum += source * in.irradiance * view * transmittance(s.media, {x, in.to_light}, {0, in.distance}) * dt;
    }
  }
  return sum;
}

std::shared_ptr<const VoxelGrid> plume() {
  static const auto grid =
      std::make_shared<VoxelGrid>(read_vdb(AIRLIGHT_SOURCE_DIR "/experiments/data/plume_0024.vdb"));
  return grid;
}

Medium smoke() {
  Medium m;
  m.field = plume();
  m.sigma_t = Rgb(6, 8, 12);
  m.albedo = Rgb(0.9, 0.8, 0.7);
  m.phase = HenyeyGreenstein{0.4};
  return m;
}

// Rays from the front through the middle of the plume.
std::vector<Ray> rays() {
  const Box box = bounding_box(smoke());
  const Point3 eye = box.center() + Vec3(0.3, 0.2, 3);
  std::vector<Ray> list;
  for (const Vec3& to : {Vec3(0, 0, 0), Vec3(0.2, 0.3, 0), Vec3(-0.15, -0.4, 0.1)})
    list.push_back({eye, (box.center() + to - eye).normalized()});
  return list;
}

}  // namespace

// The integrand has kinks at every voxel face that light or view path crosses: midpoint sums converge as n^-2 with a
// rough constant, 1e-6 at 40 000 steps (halving the steps moves them by less).
TEST_CASE("real smoke agrees with brute force", "[deterministic]") {
  Scene s;
  s.media = {smoke()};
  const Box box = bounding_box(s.media[0]);
  for (const Light& light : std::vector<Light>{DirectionalLight{Vec3(0.5, 0.8, 0.3).normalized(), Rgb(1, 2, 3)},
                                               PointLight{box.center() + Vec3(0.1, 0.2, 0.4), Rgb::Ones(), 0}}) {
    s.lights = {light};
    for (const Ray& ray : rays()) {
      const auto fine = deterministic::airlight(s, ray, infinity, {1e-8});
      const auto coarse = deterministic::airlight(s, ray, infinity, {1e-4});
      CHECK(fine.converged);
      CHECK(coarse.converged);
      const Rgb brute = midpoint_sum(s, ray, extent(s.media[0], ray, {0, infinity}), 40000);
      for (int c = 0; c < 3; ++c) {
        CHECK(fine.radiance[c] == Approx(brute[c]).epsilon(2e-6));
        CHECK(coarse.radiance[c] == Approx(fine.radiance[c]).epsilon(1e-4));
      }
    }
  }
}

// Smoke in coloured haze with clouds, three lights: everything at once. The spot's edge and the haze's border limit the
// sum.
TEST_CASE("overlapping coloured media agree with brute force", "[deterministic]") {
  Scene s;
  const Box box = bounding_box(smoke());
  Medium haze;
  haze.region = Sphere{box.center(), 1.5};
  haze.sigma_t = Rgb(0.3, 0.2, 0.1);
  haze.phase = Rayleigh{};
  Medium clouds;
  clouds.field =
      GaussianSum{{{box.center() + Vec3(0.3, 0, 0), 0.2, 3}, {box.center() + Vec3(0, 0.4, 0.2), 0.1, 20}}, 0, 3.0};
  clouds.sigma_t = Rgb(0.5, 1, 1);
  clouds.phase = Murky{};
  s.media = {smoke(), haze, clouds};
  s.lights = {PointLight{box.center() + Vec3(0.7, 0.9, 0.4), Rgb(1, 2, 1), 0},
              SpotLight{box.center() + Vec3(0, 2, 0), Vec3(0.1, -1, 0).normalized(), 0.1, 0.3, Rgb::Constant(5), 0},
              DirectionalLight{Vec3(-0.5, 0.2, 0.9).normalized(), Rgb::Ones()}};
  for (const Ray& ray : rays()) {
    const auto got = deterministic::airlight(s, ray, infinity, {1e-8});
    CHECK(got.converged);
    const Rgb brute = midpoint_sum(s, ray, clip(haze.region, ray, {0, infinity}), 40000);
    for (int c = 0; c < 3; ++c) CHECK(got.radiance[c] == Approx(brute[c]).epsilon(2e-5));
  }
}

}  // namespace brute_force_test
