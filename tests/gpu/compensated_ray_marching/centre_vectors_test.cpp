// The oracle's numbers of `variant = paper` on the device: harmonics and their exponentials as the shaders of the centres have them, the
// diffusion system, phase functions. In double precision, so that the oracle's own tolerances hold where no table is read.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/centre_sources.h"
#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"
#include "tests/oracle_vectors.h"

namespace centre_vectors_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;
using gpu::Buffer;
using gpu::compensated_ray_marching::CentreTables;
using gpu::compensated_ray_marching::Definitions;

namespace {

std::vector<json> of_kind(const std::string& kind) { return vectors_of("compensated_ray_marching", kind); }
void check_close(const std::vector<double>& got, const std::vector<double>& expected, const json& v) {
  REQUIRE(got.size() == expected.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    CAPTURE(v.at("id").get<std::string>(), i, 1e12 * (got[i] - expected[i]), expected[i]);
    CHECK(std::abs(got[i] - expected[i]) <=
          number(v.at("atol")) + number(v.at("rtol")) * std::abs(expected[i]) + gpu::test::injected_error());
  }
}
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / (4 * pi));  // RMS over the sphere
}

// What passed.glsl does, one step of it.
const char* steps = R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/passed.glsl"
layout(std430, binding = 1) writeonly buffer Result { double result[]; };
layout(std430, binding = 4) readonly buffer Given { double given[]; };  // two vectors, or one of a zonal function
uniform int what;
uniform double extinction, sine;
uniform dvec3 at_point, axis;
void main() {
  int from = LOBE;
  if (what == 0) {  // product
    if (lane < BANDS) vectors[GIVEN + lane] = given[lane];
    if (lane < BANDS) vectors[SMALL + lane] = given[BANDS + lane];
    barrier();
    multiply(GIVEN, SMALL, 1);
    from = GIVEN;
  } else if (what == 1) {  // about an axis
    for (int l = 0; l < SH_ORDER; ++l) band[l] = bits_of(given[l]);
    clear_rows();
    if (lane == 0) add_about(axis, 1);
    sum_rows(LOBE);
  } else if (what == 2) {  // what passes to a point; minus the depth after it
    find_hidden(at_point, -1);
    find_depth(at_point);
    pass(extinction);
    if (lane < BANDS) result[BANDS + lane] = vectors[DEPTH + lane];
    from = RESULT;
  } else {  // an angle, or how many terms all products have
    int count = 0;
    for (int b = 0; b < BANDS; ++b) count += terms[b].j - terms[b].i;
    if (lane == 0) result[0] = what == 3 ? place_of_shadow(sine) / SHADOWS_PER_ANGLE : double(count);
    return;
  }
  if (lane < BANDS) result[lane] = vectors[from + lane];
}
)";

class Steps {
 public:
  Steps(gpu::Context& context, int order, Transmittance kind, double cutoff, const std::vector<scene::Gaussian>& smoke,
        bool objects = false)
      : context_(context), tables_(context, order, kind, cutoff, objects), bands_(std::size_t(order * order)) {
    std::vector<double> values;
    for (const scene::Gaussian& g : smoke)
      for (const double v : {g.center[0], g.center[1], g.center[2], g.width, g.amplitude}) values.push_back(v);
    centres_ = std::make_unique<Buffer>(context, "centres", values);
    nothing_ = std::make_unique<Buffer>(context, "no spheres", 4);
    Definitions definitions = tables_.definitions();
    using namespace gpu::compensated_ray_marching;
    for (const auto& [name, at] : {std::pair("CENTRE_TABLES", at::centre_tables),
                                   {"CENTRES", at::centres},
                                   {"SPHERES", at::spheres},
                                   {"TERMS", at::terms}})
      definitions[std::string("AT_") + name] = std::to_string(int(at));
    definitions["LOCAL_SIZE_X"] = "64";
    program_ = std::make_unique<gpu::Program>(context, "test.comp", definitions);
    program_->set("gaussian_count", int(smoke.size()));
    program_->set("sphere_count", 0);
  }
  std::vector<double> product(const std::vector<double>& f, const std::vector<double>& g) {
    std::vector<double> both = f;
    both.insert(both.end(), g.begin(), g.end());
    return first(run(0, both));
  }
  std::vector<double> about(std::vector<double> zonal, const Vec3& axis) {
    for (std::size_t l = 0; l < zonal.size(); ++l) zonal[l] *= gpu::compensated_ray_marching::about_axis_factor(int(l));
    program_->set_double("axis", axis);
    return first(run(1, zonal));
  }
  struct Passed {
    std::vector<double> passed, minus_depth;  // of an extinction of 1
  };
  Passed passed(const Point3& x, double extinction) {
    program_->set_double("at_point", x);
    program_->set_double("extinction", extinction);
    const std::vector<double> all = run(2, {0.0});
    return {first(all), {all.begin() + long(bands_), all.end()}};
  }
  double angle_of(double sine) {  // by the table of shadows
    program_->set_double("sine", sine);
    return run(3, {0.0}).at(0);
  }
  double terms_of_products() { return run(4, {0.0}).at(0); }

 private:
  std::vector<double> first(const std::vector<double>& all) const { return {all.begin(), all.begin() + long(bands_)}; }
  std::vector<double> run(int what, const std::vector<double>& given) {
    const Buffer in(context_, "given", given), result(context_, "result", 8 * 2 * bands_);
    tables_.bind(*program_);
    tables_.bind_terms();
    centres_->bind(gpu::compensated_ray_marching::at::centres);
    nothing_->bind(gpu::compensated_ray_marching::at::spheres);
    in.bind(4);
    result.bind(1);
    program_->set("what", what);
    program_->dispatch(64);
    return result.download<double>();
  }

  gpu::Context& context_;
  CentreTables tables_;
  std::size_t bands_;
  std::unique_ptr<Buffer> centres_, nothing_;
  std::unique_ptr<gpu::Program> program_;
};

}  // namespace

DEVICE_TEST_CASE("products and rotations of harmonics on the device are the oracle's",
                 "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(steps);
  Steps on_device(context, 4, Transmittance::series, 3, {}, true);
  for (const json& v : of_kind("sh_triple_product"))
    check_close(on_device.product(numbers(v.at("input").at("f")), numbers(v.at("input").at("g"))),
                numbers(v.at("expected")), v);
  for (const json& v : of_kind("sh_triple_entry")) {
    std::array<std::size_t, 3> at;
    for (std::size_t a = 0; a < 3; ++a) at[a] = std::size_t(number(v.at("input").at(std::string(1, char('i' + a)))));
    std::vector<double> f(16, 0.0), g(16, 0.0);
    f[at[0]] = g[at[1]] = 1;
    check_close({on_device.product(f, g)[at[2]]}, {number(v.at("expected"))}, v);
  }
  for (const json& v : of_kind("zh_rotation"))
    check_close(on_device.about(numbers(v.at("input").at("zonal")), vec(v.at("input").at("axis")).normalized()),
                numbers(v.at("expected")), v);
  for (const json& v : of_kind("sh_triple_counts")) {
    const json& orders = v.at("input").at("orders");
    for (std::size_t i = 0; i < orders.size(); ++i)
      CHECK(Steps(context, int(number(orders[i])), Transmittance::series, 3, {}).terms_of_products() ==
            number(v.at("expected").at("nonzero")[i]));
  }
  // An object hides light from outside of it alone: angles beyond pi/2 are those of Gaussians, which are tabulated by distance here.
  int angles = 0;
  for (const json& v : of_kind("theta_of_d")) {
    const double d = number(v.at("input").at("d"));
    if (d < 1) continue;
    check_close({on_device.angle_of(1 / d)}, {number(v.at("expected"))}, v);
    ++angles;
  }
  CHECK(angles == 3);
}

DEVICE_TEST_CASE("depths of Gaussians in harmonics on the device are the oracle's", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(steps);
  for (const json& v : of_kind("rbf_zh_optical_depth")) {
    const json& in = v.at("input");
    const double d = number(in.at("d")), radius = number(in.at("radius")),
                 cut = in.at("cut").is_null() ? infinity : number(in.at("cut"));
    const int order = in.at("order");
    const Vec3 axis = Vec3(1, -2, 2) / 3;
    Steps on_device(context, order, Transmittance::series, cut, {{d * radius * axis, radius, 1}});
    std::vector<double> depth = on_device.passed(Point3::Zero(), 1).minus_depth, expected = numbers(v.at("expected"));
    for (double& value : depth) value = -value;
    CAPTURE(v.at("id").get<std::string>());
    // The table, as the processor reads it, and what 256 samples of it leave (harmonics_test.cpp: 9e-5 of a band at most).
    const DepthTable table(order, DepthTable::Spacing::even, depth_samples, cut);
    std::vector<double> between(expected.size());
    table.zonal(d, between.data());
    for (double& value : between) value *= radius;
    const Vec3 seen = d > 0 ? axis : Vec3::UnitZ();
    CHECK(distance(depth, about_axis(between, seen)) < 1e-12 + gpu::test::injected_error());
    CHECK(distance(depth, about_axis(expected, seen)) < 9e-5 * std::sqrt(order / (4 * pi)));
    CHECK(distance(depth, about_axis(expected, seen)) <
          1e-4 * distance(expected, std::vector<double>(expected.size(), 0.0)));
  }
}

DEVICE_TEST_CASE("exponentials in harmonics on the device go as near the oracle as the processor's",
                 "[gpu][compensated_ray_marching][thorough]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(steps);
  for (const json& v : of_kind("sh_exponential")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const double sigma_t = number(in.at("sigma_t"));
    std::vector<scene::Gaussian> smoke;
    double most = 0;  // of the depths that are added
    for (const json& b : in.at("blockers_xyz_r_w")) {
      smoke.push_back({vec(b), number(b[3]), number(b[4])});
      most += sigma_t * smoke.back().width * smoke.back().amplitude;
    }
    const std::vector<double> oracle = numbers(expected.at("exp_of_bandlimited"));
    for (const Transmittance kind :
         {Transmittance::paper_linear, Transmittance::paper_squared, Transmittance::series}) {
      const auto of = [&](const Harmonics& f) {
        return kind == Transmittance::paper_linear ? linear_exponential(4)(f)
               : kind == Transmittance::paper_squared
                   ? squared_exponential(f, linear_exponential(4), squaring_threshold)
                   : series_exponential(f);
      };
      Steps::Passed got = Steps(context, 4, kind, 3, smoke).passed(Point3::Zero(), sigma_t);
      for (double& value : got.minus_depth) value *= sigma_t;
      const std::vector<double> depth = numbers(expected.at("minus_depth_vector"));
      CAPTURE(v.at("id").get<std::string>(), int(kind), distance(of(depth), oracle));
      // By tables of 256 distances.
      CHECK(distance(got.minus_depth, depth) < most * 9e-5 * std::sqrt(4 / (4 * pi)));
      CHECK(distance(got.passed, of(got.minus_depth)) < 1e-12 + 10 * gpu::test::injected_error());
      // The method's own error, and what the tables' is multiplied by: exponentials of what is below 0 on the whole sphere are at most 1.
      CHECK(distance(got.passed, oracle) < distance(of(depth), oracle) + most * 9e-5);
    }
  }
}

// What the device scatters of a light that nothing dims: convolution with the phase function, in single precision.
DEVICE_TEST_CASE("light is convolved with the phase function on the device as the oracle's is",
                 "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const auto scattered = [&](double g, const std::vector<double>& light, const Vec3& direction) {
    scene::Medium medium;
    scene::GaussianSum sum;
    sum.cutoff = 3;
    sum.gaussians = {{Point3::Zero(), 1, 1}};
    medium.field = sum;
    medium.sigma_t = Rgb::Constant(1e-12);
    medium.albedo = Rgb::Ones();
    medium.phase = scene::HenyeyGreenstein{g};
    Options options;
    options.variant = Options::Variant::paper;
    options.paper.multiple = Options::Paper::Multiple::none;
    options.paper.transmittance = Transmittance::series;
    gpu::StageTimer timer(context);
    gpu::compensated_ray_marching::CentreSourcesOnDevice centres(context, sum, medium, {}, true, nullptr, {}, options,
                                                                 timer, {1, {}});
    std::vector<Rgb> bands;
    for (const double b : light) bands.push_back(Rgb::Constant(b));
    centres.light(bands, timer, {1, {}});
    scene::View view{scene::look_at(direction, Point3::Zero(), Vec3(0.3, 0.5, -0.7)), 1, 1};
    view.camera.kind = scene::Camera::Kind::orthographic;
    centres.towards(view);
    return double(centres.sources().download<std::array<float, 4>>().at(0)[0]);
  };
  // Light that propagates in a direction, as the oracle's convolution of it: in harmonics of propagation, without 1 / 4 pi.
  const auto compare = [&](const json& v, double g, const std::vector<double>& light,
                           const std::vector<double>& convolved) {
    double squares = 0, off = 0;
    for (const Ordinate& d : ordinate_directions(4, 8, false)) {
      const std::vector<double> y = scene::evaluate_sh(4, d.direction);
      double expected = 0;
      for (std::size_t i = 0; i < 16; ++i) expected += convolved[i] * y[i] / (4 * pi);
      squares += d.weight * expected * expected;
      off += d.weight * std::pow(scattered(g, turned_back(light), d.direction) - expected, 2);
    }
    CAPTURE(v.at("id").get<std::string>());
    CHECK(std::sqrt(off / squares) < 1e-6 + gpu::test::injected_error());
  };
  for (const json& v : of_kind("sh_convolution")) {
    const std::vector<double> zonal = numbers(v.at("input").at("zonal"));
    compare(v, zonal[1] / zonal[0] / std::sqrt(3), numbers(v.at("input").at("f")), numbers(v.at("expected")));
  }
  // Of light from one direction the phase function about it is left.
  for (const json& v : of_kind("hg_zh")) {
    const Vec3 axis = Vec3(2, -1, 2) / 3;
    compare(v, number(v.at("input").at("g")), scene::evaluate_sh(4, axis), about_axis(numbers(v.at("expected")), axis));
  }
}

DEVICE_TEST_CASE("the diffusion system on the device is the oracle's", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  namespace at = gpu::compensated_ray_marching::at;
  for (const json& v : of_kind("collocation_matrix")) {
    const json& in = v.at("input");
    const double sigma_t = number(in.at("sigma_t")), albedo = number(in.at("albedo")), g = number(in.at("g")),
                 transport = (1 - albedo * g) * sigma_t;
    std::vector<double> gaussians;
    for (const json& b : in.at("rbf_x_y_z_r_w"))
      for (const double value : numbers(b)) gaussians.push_back(value);
    const std::size_t n = gaussians.size() / 5;
    std::vector<double> single(3 * 4 * n, 0.0);  // [channel][band][centre]
    for (std::size_t b = 0; b < 4; ++b)
      for (std::size_t i = 0; i < n; ++i) single[b * n + i] = number(in.at("Jss_sh_order2")[i][b]);
    const CentreTables tables(context, 2, Transmittance::series, infinity, false);
    const auto program_of = [&](const char* file, const char* sums) -> gpu::Program& {
      Definitions definitions = tables.definitions();
      definitions["SUMS"] = sums;
      return gpu::compensated_ray_marching::program(context, file, 64, 1, definitions);
    };
    const Buffer centres(context, "centres", gaussians), sources(context, "sources", single),
        matrix(context, "matrix", 8 * n * n), scales(context, "scales", 8 * n), vectors(context, "vectors", 8 * 6 * n),
        systems(context, "systems", 64);
    gpu::Program& of_matrix = program_of("diffusion_matrix", "5");
    centres.bind(at::centres);
    matrix.bind(at::matrix);
    scales.bind(at::row_scales);
    of_matrix.set("gaussian_count", int(n));
    of_matrix.set("scaled", false);
    of_matrix.set_double("transport", transport);
    of_matrix.set_double("absorption", (1 - albedo) * sigma_t);
    of_matrix.dispatch(64 * int(n));
    for (const bool printed : {false, true}) {
      const json& expected = v.at("expected").at(printed ? "as_printed" : "corrected");
      std::vector<double> rows;
      for (const json& row : expected.at("A"))
        for (const double value : numbers(row)) rows.push_back(value);
      check_close(matrix.download<double>(), rows, v);
      gpu::Program& of_right = program_of("diffusion_right", "9");
      centres.bind(at::centres);
      sources.bind(at::single_bands);
      scales.bind(at::row_scales);
      vectors.bind(at::vectors);
      systems.bind(at::systems);
      of_right.set("gaussian_count", int(n));
      of_right.set("first_system", 0);
      of_right.set("channel[0]", 0);
      // As CentreSourcesOnDevice has them.
      of_right.set_double("of_mean", printed ? -sigma_t / albedo : -sigma_t);
      of_right.set_double("of_gradient", sigma_t / ((printed ? 1 : 3) * transport));
      of_right.dispatch(64 * int(n));
      std::vector<double> right = vectors.download<double>();
      right.resize(n);
      check_close(right, numbers(expected.at("b")), v);
    }
  }
}

}  // namespace centre_vectors_test
