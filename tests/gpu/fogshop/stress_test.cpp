// The stress table of tests/methods/fogshop on the device: in single precision, right to the accuracy of its error
// function, or the limit that is stated, and never NaN.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/fogshop/passes.h"
#include "tests/gpu/device.h"
#include "tests/methods/fogshop/ray_model.h"
#include "tests/methods/fogshop/stress_cases.h"

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact;
using fogshop_test::grey_fog;
using scene::Gaussian;

namespace {

// a = 1/width, c = amplitude.
Gaussian gaussian(double a, double c, const Point3& b) { return {b, 1 / a, c}; }

struct RayAnswer {
  std::array<float, 3> airlight;
  float depth;
};

// One ray along +z.
RayAnswer one_ray(gpu::Context& context, const Options& options, const Fog& fog, const Point3& view, double length,
                  const Point3* light) {
  Model model;
  model.options = options;
  model.fog = fog;
  model.gaussians = make_arrays(fog.sum.gaussians, options.cull, options.depth_threshold).arrays;
  if (light) model.lights.push_back({*light, Rgb::Ones(), {}, nullptr});
  gpu::FogOnDevice device(context, model);
  if (light && model.paper()) {
    device.fill_light_depths();
    device.fill_view_depths(view);
  }
  gpu::StageTimer timer(context);
  const scene::View one{scene::look_at(view, view + Vec3::UnitZ(), Vec3::UnitY()), 1, 1};
  const gpu::Buffer distance(context, "distances",
                             std::vector<float>{length < gpu::far_away ? float(length) : gpu::far_away});
  return device.airlight(one, &distance, timer)->download<RayAnswer>().at(0);
}

}  // namespace

TEST_CASE("depths under extreme inputs on the device", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  struct Case {
    double a, c;
    Point3 b;
    double d, expected;
  };
  const Case cases[] = {
      {1, 1e6, {0, 0, 3}, 6, 1.772414696519e6},
      {1e-6, 1e6, {0, 0, 3}, infinity, 8.862299254528e11},
      {1e6, 1e6, {1e-6, 0, 3}, 6, 0.6520493321733},
      {1e6, 1, {1e-4, 0, 3}, 6, 0},  // 2e-4349
      {1e-6, 1, {0, 0, 1e6}, 1e6, 7.468241328124e5},
      {1, 1, {0, 0, -1}, infinity, 0.1394027926403},
      {1, 1, {0, 0, -26}, infinity, 0},  // 5e-296
      {1, 1e-8, {0, 0, 3}, 6, 1.772414696519e-8},
      {1, 1, {0, 0, 3}, 1e-15, 1.234098040867e-19},
      {1, 1, {0, 0, 8}, 7.9999999, 0.8862268254528},
      {1, 0, {0, 0, 3}, 6, 0},
      {1, 1, {0, 0, 3}, 0, 0},
  };
  for (const Case& c : cases) {
    INFO(c.a << " " << c.c << " " << c.b.transpose() << " " << c.d);
    const double got = one_ray(*context, exact(Options::Variant::slices, 8),
                               grey_fog({{gaussian(c.a, c.c, c.b)}, 0, infinity}), Point3::Zero(), c.d, nullptr)
                           .depth;
    // The error function is good to 3.3e-7. The depth of a step of 1e-15 is lost in its rounding.
    CHECK(std::abs(got - c.expected) <= 3.3e-7 * c.c * std::sqrt(pi) / c.a);
  }
}

TEST_CASE("airlight of one Gaussian under extreme inputs on the device", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  for (const fogshop_test::StressCase& c : fogshop_test::stress_cases) {
    const Fog fog = grey_fog({{c.gaussian()}, 0, infinity});
    INFO(c.expected);
    // With the 128 slices that a shader has room for, what is left of K^-4 is below 2e-4. The nearest light, 1e-4 from
    // the ray, shines on slices so short that their depths have four digits.
    Options slices = exact(Options::Variant::slices, 128);
    slices.extrapolate = true;
    slices.boxes = true;
    const Line ray{c.view, Vec3::UnitZ(), c.d};
    const double got = one_ray(*context, slices, fog, c.view, c.d, &c.light).airlight[0];
    CHECK(std::abs(got / c.expected - 1) <= 1e-3);
    CHECK(std::abs(got / fogshop_test::ray_airlight(slices, fog, c.light, Rgb::Ones(), ray)[0] - 1) <= 1e-3);
    // The paper's variant has its own answer; what is below 1e-38 is 0.
    const Options paper = exact(Options::Variant::paper, 8);
    const double ours = one_ray(*context, paper, fog, c.view, c.d, &c.light).airlight[0];
    const double theirs = fogshop_test::ray_airlight(paper, fog, c.light, Rgb::Ones(), ray)[0];
    CHECK(std::abs(ours - theirs) <= 2e-5 * theirs + 1e-38);
  }
}

TEST_CASE("airlight of a constant medium under extreme inputs on the device", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  struct Case {
    double gamma, d_sv, d_vp, beta, radius, expected;
  };
  const Case cases[] = {
      {0.5, 1, 0, 1, 0, 0},
      {0.5, 1, 2, 0, 0, 0},
      {pi / 2, 1, infinity, 1e-8, 0, 1.249999705613e-9},
      {1e-8, 1, 0.5, 1, 0, 0.02927491576216},
      {1e-8, 1, 2, 1, 0, 9.196984895631e6},
      {pi, 1, infinity, 1, 0, 0.008119186118439},
      {1, 1, infinity, 1e4, 0, 0},  // 2e-4344
      {2, 1e-6, infinity, 1, 0, 99904.72513203},
      {0, 0, infinity, 0.5, 0.01, 6.049635435552},
  };
  for (const Case& c : cases) {
    INFO(c.gamma << " " << c.d_sv << " " << c.d_vp << " " << c.beta);
    const Point3 light(c.d_sv * std::sin(c.gamma), 0, c.d_sv * std::cos(c.gamma));
    Options options = exact(Options::Variant::slices, 8);
    options.source_radius = c.radius;
    const double got =
        one_ray(*context, options, grey_fog({{}, c.beta, infinity}), Point3::Zero(), c.d_vp, &light).airlight[0];
    CHECK(std::abs(got - c.expected) <= 5e-7 * c.expected);
  }
}
