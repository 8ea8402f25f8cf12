// The stress table of tests/methods/fogshop on the device: in single precision, right to the accuracy of its error
// function, or the limit that is stated, and never NaN.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/interface.h"
#include "gpu/program.h"
#include "methods/fogshop/surface_psf.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"
#include "tests/methods/fogshop/ray_model.h"
#include "tests/methods/fogshop/stress_cases.h"

namespace stress_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact;
using fogshop_test::grey_fog;

namespace {

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
  Needs needs{};
  needs.airlight = true;
  needs.center_depths = light && model.paper() && model.gaussians.count > 0;
  gpu::fogshop::FogOnDevice device(context, model, needs);
  if (needs.center_depths) {
    device.fill_light_depths();
    device.fill_view_depths(view);
  }
  gpu::Frame frame(context);
  frame.begin({});
  const scene::View one{scene::look_at(view, view + Vec3::UnitZ(), Vec3::UnitY()), 1, 1};
  const gpu::Buffer distance(context, "distances",
                             std::vector<float>{length < gpu::far_away ? float(length) : gpu::far_away});
  return device.airlight(one, &distance, frame).download<RayAnswer>().at(0);
}

}  // namespace

DEVICE_TEST_CASE("depths under extreme inputs on the device", "[gpu]") {
  for (const fogshop_test::DepthCase& c : fogshop_test::depth_cases) {
    INFO(c.a << " " << c.c << " " << c.b.transpose() << " " << c.d);
    const double got = one_ray(context, exact(Options::Variant::slices, 8), grey_fog({{c.gaussian()}, 0, infinity}),
                               Point3::Zero(), c.d, nullptr)
                           .depth;
    // The error function is good to 3.3e-7. The depth of a step of 1e-15 is lost in its rounding.
    CHECK(std::abs(got - c.depth) <= (3.3e-7 + gpu::test::injected_error()) * c.c * std::sqrt(pi) / c.a);
  }
}

// Depths of slices are differences of what the error function lacks to its limit, each as wrong as the exponential in it. The
// minuend over the difference where the light comes from: on a stretch as long as the light is away, the Gaussian wide, or
// the view deep.
double tail_over_slices(const fogshop_test::StressCase& c) {
  double most = 0, ratio = 0;
  const int steps = 100000;
  for (int i = 0; i <= steps; ++i) {
    const double z = c.d * i / steps, s = c.view.z() + z - c.b.z();
    const Vec3 to_light = c.light - (c.view + z * Vec3::UnitZ());
    const double across = (c.view - c.b).head<2>().squaredNorm(), peak = c.c * std::exp(-c.a * c.a * across);
    const double density = peak * std::exp(-c.a * c.a * s * s), half = peak * std::sqrt(pi) / (2 * c.a);
    const double seen = std::exp(-half * (std::erf(c.a * s) - std::erf(c.a * (s - z))));
    const double light = density * seen / to_light.squaredNorm();
    if (light <= most) continue;
    most = light;
    ratio = half * std::erfc(c.a * std::abs(s)) / (density * std::min({to_light.norm(), 1 / c.a, 1 / density}));
  }
  return ratio;
}

DEVICE_TEST_CASE("airlight of one Gaussian under extreme inputs on the device", "[gpu]") {
  for (const fogshop_test::StressCase& c : fogshop_test::stress_cases) {
    const Fog fog = grey_fog({{c.gaussian()}, 0, infinity});
    INFO(c.expected);
    // With 128 slices, what is left of K^-4 is below 2e-4. The nearest light, 1e-4 from
    // the ray, shines on slices so short that rounding takes four digits of their depths.
    Options slices = exact(Options::Variant::slices, 128);
    slices.extrapolate = true;
    slices.boxes = true;
    const Line ray{c.view, Vec3::UnitZ(), c.d};
    const double got = one_ray(context, slices, fog, c.view, c.d, &c.light).airlight[0];
    const double tails = tail_over_slices(c), bound = 2e-4 + tails * (std::exp2(-24) + gpu::test::injected_error());
    CAPTURE(tails, got);
    CHECK(std::abs(got / c.expected - 1) <= bound);
    CHECK(std::abs(got / fogshop_test::ray_airlight(slices, fog, c.light, Rgb::Ones(), ray)[0] - 1) <= bound);
    // The paper's variant has its own answer; what is below 1e-38 is 0.
    const Options paper = exact(Options::Variant::paper, 8);
    const double ours = one_ray(context, paper, fog, c.view, c.d, &c.light).airlight[0];
    const double theirs = fogshop_test::ray_airlight(paper, fog, c.light, Rgb::Ones(), ray)[0];
    CHECK(std::abs(ours - theirs) <= 2e-5 * theirs + 1e-38);
  }
}

DEVICE_TEST_CASE("airlight of a constant medium under extreme inputs on the device", "[gpu]") {
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
        one_ray(context, options, grey_fog({{}, c.beta, infinity}), Point3::Zero(), c.d_vp, &light).airlight[0];
    CHECK(std::abs(got - c.expected) <= (5e-7 + 2 * gpu::test::injected_error()) * c.expected);
  }
}

// The airlight of an endless ray at depth 1 from the light is NPSF / (e d^2) (Eq. 17). The light is 100 m away, since
// lights nearer to the ray than 1e-9 m are treated as if at 1e-9 m.
DEVICE_TEST_CASE("limits of the NPSF on the device", "[gpu]") {
  for (const auto& [gamma, expected] : {std::pair(1e-10, 2.499999996188e9), {pi, 0.02207023608763}}) {
    const Point3 light(100 * std::sin(gamma), 0, 100 * std::cos(gamma));
    const Fog fog = grey_fog({{}, 0.01, infinity});
    const double got =
        one_ray(context, exact(Options::Variant::slices, 8), fog, Point3::Zero(), infinity, &light).airlight[0];
    CAPTURE(gamma, got);
    CHECK(std::abs(1e4 * got * std::exp(1.0) / expected - 1) <= 5e-7);
  }
}

// Eq. 26 for one Gaussian, as the shader of surfaces computes it: by its fit and by its series far away.
DEVICE_TEST_CASE("average depth under extreme inputs on the device", "[gpu]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "fogshop/fog.glsl"
#include "fogshop/average_depth.glsl"
layout(std430, binding = 1) readonly buffer Distances { float distance_of[]; };
layout(std430, binding = 3) writeonly buffer Depths { float depth_of[]; };
void main() {
  int i = int(gl_GlobalInvocationID.x);
  depth_of[i] = average_depth(vec3(0, distance_of[i], 0));
}
)");
  gpu::fogshop::Definitions definitions = gpu::fogshop::dawson_definitions();
  definitions.insert({{"ERF_COUNT", "0"}, {"COLOURED", "0"}, {"AT_GAUSSIANS", "0"}});
  gpu::Program program(context, "test.comp", definitions);
  // At the origin, width 1, half_depth so that the sum is average_depth(u).
  const gpu::Buffer gaussian(context, "Gaussian",
                             std::vector<float>{0, 0, 0, 1, float(std::sqrt(pi) / 2), 1e30f, 0, 0});
  const std::vector<float> u = {0, 1e-6f, 0.3f, 1, 3, 9.99f, 10, 10.01f, 1e3f, 1e6f, 1e15f, 1e25f};
  const gpu::Buffer distances(context, "distances", u), depths(context, "depths", u.size() * 4);
  gaussian.bind(0);
  distances.bind(1);
  depths.bind(3);
  program.set("gaussian_count", 1);
  program.dispatch(int(u.size()));
  const std::vector<float> got = depths.download<float>();
  for (std::size_t i = 0; i < u.size(); ++i) {
    CAPTURE(u[i], got[i]);
    const double expected = u[i] == 1e6f ? 4.431134627266e-13 : average_depth(double(u[i]));
    if (expected < 1.2e-38)
      CHECK(got[i] == 0);
    else
      CHECK(std::abs(got[i] / expected - 1) <= 1e-6);
  }
}

}  // namespace stress_test
