#include "reference/deterministic/airlight.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/media/voxel_grid.h"

namespace airlight_test {

using namespace airlight;
using namespace airlight::scene;
using deterministic::Accuracy;
using deterministic::Airlight;

namespace {

Medium fog(const Region& region, double sigma, double albedo = 1, PhaseFunction phase = Isotropic{}) {
  Medium m;
  m.region = region;
  m.sigma_t = Rgb::Constant(sigma);
  m.albedo = Rgb::Constant(albedo);
  m.phase = phase;
  return m;
}

PointLight point(const Point3& p, double intensity = 1) { return {p, Rgb::Constant(intensity), 0}; }

Scene scene_of(std::vector<Medium> media, std::vector<Light> lights) {
  Scene s;
  s.media = std::move(media);
  s.lights = std::move(lights);
  return s;
}

double value(const Scene& s, const Ray& ray, double end, Accuracy accuracy = {}) {
  const Airlight a = deterministic::airlight(s, ray, end, accuracy);
  CHECK(a.converged);
  CHECK((a.error <= accuracy.relative_tolerance * a.radiance + 1e-300).all());
  return a.radiance[1];
}

const Ray along_z{Point3::Zero(), Vec3::UnitZ()};

}  // namespace

// A slab of optical depth tau seen and lit along z, isotropic, light from the camera's side: L = E/(4 pi) int exp(-2 s)
// ds = E/(4 pi) (1 - exp(-2 tau))/2; from behind: exp(-tau) tau E/(4 pi). Thin and thick: expm1 in the answer, not in
// the method.
TEST_CASE("airlight of a slab under a directional light has its closed form", "[deterministic]") {
  for (const double tau : {1e-8, 1e-3, 1.0, 50.0, 1e4, 1e7}) {
    CAPTURE(tau);
    const Slab slab{Vec3::UnitZ(), 1, 3};
    const Scene front = scene_of({fog(slab, tau / 2, 0.7)}, {DirectionalLight{-Vec3::UnitZ(), Rgb::Constant(2)}});
    const double c = 0.7 * 2 / (4 * pi);
    CHECK(value(front, along_z, infinity) == Approx(c * -std::expm1(-2 * tau) / 2).epsilon(1e-10));
    const Scene behind = scene_of({fog(slab, tau / 2, 0.7)}, {DirectionalLight{Vec3::UnitZ(), Rgb::Constant(2)}});
    CHECK(value(behind, along_z, infinity) == Approx(c * tau * std::exp(-tau)).epsilon(1e-10).margin(1e-300));
  }
}

// tau -> 0: a point light at distance h from a ray through a thin unbounded medium: L = sigma I/(4 pi) int dx/(x^2+h^2)
// = sigma I/(4 pi) * pi/h over the whole line. Attenuation enters with sigma times the path, of order sigma h log: 1e-6
// h.
TEST_CASE("a ray past a light at any distance keeps its digits", "[deterministic]") {
  for (const double h : {1e-12, 1e-9, 1e-6, 1e-3, 1.0}) {
    CAPTURE(h);
    const Ray ray{Point3(h, 0, -1e4), Vec3::UnitZ()};
    const Scene thin = scene_of({fog(Sphere{Point3::Zero(), 1e3}, 1e-8)}, {point(Point3::Zero())});
    // Within the ball |x| < 1e3: 2 atan(1e3/h)/h; optical paths are below 3e-5, so that the value is smaller by less.
    const double bare = 1e-8 / (4 * pi) * 2 * std::atan(1e3 / h) / h;
    const double got = value(thin, ray, infinity);
    CHECK(got < bare);
    CHECK(got > bare * (1 - 3e-5));
  }
  // Dense: exp(-2 sigma-like) tails. Compare h = 1e-9 against h = 2e-9 by the leading 1/h law; the next term is h log
  // h.
  const Scene dense = scene_of({fog(Unbounded{}, 2.0)}, {point(Point3(0, 0, 3))});
  const double near = value(dense, {Point3(1e-9, 0, 0), Vec3::UnitZ()}, infinity);
  const double far = value(dense, {Point3(2e-9, 0, 0), Vec3::UnitZ()}, infinity);
  CHECK(near == Approx(2 / (4 * pi) * pi / 1e-9 * std::exp(-6.0)).epsilon(1e-6));
  CHECK(near / far == Approx(2.0).epsilon(1e-7));
}

TEST_CASE("a ray through a light in a medium is infinite, in vacuum it is not", "[deterministic]") {
  const Scene inside = scene_of({fog(Sphere{Point3(0, 0, 5), 2}, 1)}, {point(Point3(0, 0, 5))});
  const Airlight a = deterministic::airlight(inside, along_z, infinity);
  CHECK(std::isinf(a.radiance[0]));
  CHECK_FALSE(a.converged);
  // The light sits at 8, behind the ball [3, 7]: int_3^7 exp(-(s - 3) - (7 - s)) / (8 - s)^2 ds / (4 pi) = e^-4 (1 -
  // 1/5)/(4 pi).
  const Scene outside = scene_of({fog(Sphere{Point3(0, 0, 5), 2}, 1)}, {point(Point3(0, 0, 8))});
  CHECK(value(outside, along_z, infinity) == Approx(std::exp(-4.0) * 0.8 / (4 * pi)).epsilon(1e-10));
}

// A grid of one constant value, inside its samples, is a homogeneous box; so is a Gaussian sum that is only a constant;
// so are two half media on top of each other, and one cut into two boxes.
TEST_CASE("the same fog described in five ways has one airlight", "[deterministic]") {
  const Box box{Point3(-1, -1, 2), Point3(1, 1, 5)};
  const PhaseFunction phase = HenyeyGreenstein{0.6};
  const std::vector<Light> lights = {point(Point3(0.5, 2, 3)),
                                     DirectionalLight{Vec3(1, 2, -1).normalized(), Rgb::Ones()},
                                     SpotLight{Point3(-2, 0, 4), Vec3::UnitX(), 0.1, 0.5, Rgb::Constant(3), 0}};
  const Ray ray{Point3(0.1, -0.2, 0), Vec3(0.05, 0.1, 1).normalized()};
  const double expected = value(scene_of({fog(box, 0.8, 0.9, phase)}, lights), ray, infinity);

  Medium constant = fog(box, 0.8, 0.9, phase);
  constant.field = GaussianSum{{}, 1.0, infinity};
  CHECK(value(scene_of({constant}, lights), ray, infinity) == Approx(expected).epsilon(1e-10));

  auto grid = std::make_shared<VoxelGrid>();
  grid->size = Eigen::Vector3i(8, 8, 8);
  grid->voxel_size = 1;
  grid->translation = Vec3(-4, -4, 0);
  grid->values.assign(512, 1.0f);
  Medium voxels = fog(box, 0.8, 0.9, phase);
  voxels.field = std::shared_ptr<const VoxelGrid>(grid);
  CHECK(value(scene_of({voxels}, lights), ray, infinity) == Approx(expected).epsilon(1e-10));

  CHECK(value(scene_of({fog(box, 0.3, 0.9, phase), fog(box, 0.5, 0.9, phase)}, lights), ray, infinity) ==
        Approx(expected).epsilon(1e-10));
  const Box left{box.lo, Point3(1, 1, 3.3)}, right{Point3(-1, -1, 3.3), box.hi};
  CHECK(value(scene_of({fog(left, 0.8, 0.9, phase), fog(right, 0.8, 0.9, phase)}, lights), ray, infinity) ==
        Approx(expected).epsilon(1e-9));
}

// Lengths times 2^20, extinction times 2^-20, intensity times 2^40: every operation scales exactly, so the bits are
// equal.
TEST_CASE("scaling by a power of two changes no bit", "[deterministic]") {
  const auto build = [](double scale) {
    Medium m = fog(Unbounded{}, 1 / scale);
    m.field = GaussianSum{
        {{Point3(0, 0, 4) * scale, 1.25 * scale, 0.5}, {Point3(1, 0.5, 5) * scale, 0.75 * scale, 1}}, 0.125, infinity};
    return scene_of({m}, {point(Point3(1, 2, 3) * scale, scale * scale)});
  };
  const double one = value(build(1), along_z, 8);
  const double s = std::ldexp(1, 20);
  CHECK(value(build(s), along_z, 8 * s) == one);
}

TEST_CASE("a budget that is too small is reported", "[deterministic]") {
  const Scene s = scene_of({fog(Sphere{Point3(0, 0, 5), 2}, 300)}, {point(Point3(0.5, 2.5, 5))});
  const Airlight a = deterministic::airlight(s, along_z, infinity, {1e-10, 60});
  CHECK_FALSE(a.converged);
  CHECK(a.radiance.allFinite());
}

// A hundred thousand Gaussians of depth 1e-9 each at one place are one of depth 1e-4; 10 million widths away nothing is left.
TEST_CASE("many faint Gaussians add up", "[deterministic]") {
  Medium one = fog(Unbounded{}, 1), many = fog(Unbounded{}, 1);
  one.field = GaussianSum{{{Point3(0, 0, 5), 1, 1e-4}}, 0, infinity};
  GaussianSum sum;
  sum.gaussians.assign(100000, {Point3(0, 0, 5), 1, 1e-9});
  many.field = sum;
  const std::vector<Light> lights = {point(Point3(0.2, 1, 4))};
  CHECK(value(scene_of({many}, lights), along_z, 10, {1e-6}) ==
        Approx(value(scene_of({one}, lights), along_z, 10)).epsilon(1e-6));
}

}  // namespace airlight_test
