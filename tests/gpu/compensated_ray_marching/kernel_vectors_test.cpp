// The oracle's numbers on the device, kernel by kernel: decoding of hashes, density between voxels, harmonics, slices of even smoke. In
// single precision: what places and sums are rounded to, beside the oracle's own tolerances of doubles.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/marched_smoke.h"
#include "gpu/compensated_ray_marching/residual_store.h"
#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/convert/residual.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"
#include "tests/oracle_vectors.h"

namespace kernel_vectors_test {

using namespace airlight;
using namespace airlight::test;
using Eigen::Vector3i;
using gpu::Buffer;
using gpu::compensated_ray_marching::ResidualOnDevice;
using Membership = ResidualOnDevice::Membership;

namespace {

std::vector<json> of_kind(const std::string& kind) { return vectors_of("compensated_ray_marching", kind); }
Vector3i integers(const json& v) { return {v[0].get<int>(), v[1].get<int>(), v[2].get<int>()}; }
int level_at(gpu::Context& context, const ResidualOnDevice& residual, const Vector3i& p) {
  return levels_on_device(context, residual, p, Vector3i::Ones()).at(0);
}

scene::VoxelGrid grid_of(const json& in) {
  scene::VoxelGrid grid;
  grid.size = integers(in.at("resolution"));
  const json& values = in.at("values_x_y_z");
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int x = 0; x < grid.size[0]; ++x)
        grid.values.push_back(float(number(values[std::size_t(x)][std::size_t(y)][std::size_t(z)])));
  return grid;
}
scene::Medium medium_of(scene::VoxelGrid grid, double sigma_t) {
  scene::Medium medium;
  medium.field = std::make_shared<const scene::VoxelGrid>(std::move(grid));
  medium.sigma_t = Rgb::Constant(sigma_t);
  return medium;
}

}  // namespace

DEVICE_TEST_CASE("the oracle's residuals come back from hashes and bricks on the device", "[gpu][residual]") {
  const gpu::Use use(context);
  int seen = 0;
  for (const json& v : of_kind("hash_round_trip")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const Vector3i domain = integers(in.at("domain"));
    std::vector<double> residual(std::size_t(domain.prod()), 0.0);
    for (std::size_t i = 0; i < in.at("positions").size(); ++i) {
      const Vector3i p = integers(in.at("positions")[i]);
      residual[std::size_t(p[0] + domain[0] * (p[1] + domain[1] * p[2]))] = number(in.at("residual")[i]);
    }
    const scene::ResidualLevels levels = scene::quantised(domain, residual, {in.at("threshold"), {}});
    const auto hash = scene::perfect_hash(domain, scene::hashed_voxels(domain, levels.values));
    const ResidualOnDevice kinds[] = {{context, domain, scene::apron_bricks_of(domain, levels.values)},
                                      {context, domain, hash, Membership::tags},
                                      {context, domain, hash, Membership::domain}};
    CAPTURE(v.at("id").get<std::string>());
    for (const ResidualOnDevice& on_device : kinds) {
      const std::vector<int> all = levels_on_device(context, on_device, Vector3i::Zero(), domain);
      CHECK(std::count_if(all.begin(), all.end(), [](int level) { return level != 0; }) ==
            number(expected.at("count")));
      for (std::size_t i = 0; i < in.at("positions").size(); ++i) {
        const int level = level_at(context, on_device, integers(in.at("positions")[i]));
        CHECK(level == expected.at("quantised")[i].get<int>());
        CHECK(levels.step * level == Approx(number(expected.at("decoded")[i])).epsilon(1e-12).margin(1e-15));
      }
      for (const json& p : in.at("absent_positions")) CHECK(level_at(context, on_device, integers(p)) == 0);
    }
    ++seen;
  }
  CHECK(seen == 3);
}

DEVICE_TEST_CASE("addresses of a perfect hash on the device are those of the definition", "[gpu][residual]") {
  const gpu::Use use(context);
  for (const json& v : of_kind("psh_address")) {
    scene::PerfectHash hash;
    hash.m = v.at("input").at("m");
    hash.r = v.at("input").at("r");
    const std::size_t m = std::size_t(hash.m), r = std::size_t(hash.r);
    const Vector3i p = integers(v.at("input").at("p")), offset = integers(v.at("input").at("offset")),
                   at = integers(v.at("expected").at("offset_slot")), slot = integers(v.at("expected").at("hash_slot"));
    hash.extent = Vector3i::Constant(64);
    hash.offsets.assign(r * r * r, 0);
    hash.values.assign(m * m * m, 1);  // at every other slot something else
    hash.tags.assign(m * m * m, 0);
    hash.domain.assign(64 * 64, ~std::uint64_t(0));
    hash.offsets[std::size_t(at[0]) + r * (std::size_t(at[1]) + r * std::size_t(at[2]))] =
        std::uint32_t(offset[0] | offset[1] << 10 | offset[2] << 20);
    const std::size_t where = std::size_t(slot[0]) + m * (std::size_t(slot[1]) + m * std::size_t(slot[2]));
    hash.values[where] = 77;
    hash.tags[where] = std::uint32_t(p[0] + 64 * (p[1] + 64 * p[2]));
    for (const Membership membership : {Membership::tags, Membership::domain})
      CHECK(level_at(context, {context, hash.extent, hash, membership}, p) == 77);
  }
}

DEVICE_TEST_CASE("density between voxels and at their border on the device is the oracle's",
                 "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_density.glsl"
layout(std430, binding = 1) readonly buffer Points { vec4 points[]; };
layout(std430, binding = 2) writeonly buffer Result { float result[]; };
uniform int count;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < count) result[i] = density_at(points[i].xyz);
}
)");
  for (const json& v : of_kind("trilinear_border"))
    for (const bool clamped : {true, false}) {
      const json &in = v.at("input"), &expected = v.at("expected").at(clamped ? "clamp" : "zero");
      scene::VoxelGrid grid = grid_of(in);
      grid.clamp_border = clamped;
      const Vec3 lo = vec(in.at("box_min")), hi = vec(in.at("box_max"));
      const scene::Medium medium = medium_of(grid, 1);
      const compensated_ray_marching::SmokeField field(medium, {});
      const Point3 middle(0.9, 1.1, 1.6);
      const gpu::compensated_ray_marching::SmokeDensity density(context, field, middle, false);
      std::vector<std::array<float, 4>> points;
      for (const json& p : in.at("points")) {
        const Vec3 sample =
            (vec(p) - lo).cwiseQuotient(hi - lo).cwiseProduct(grid.size.cast<double>()) - Vec3::Constant(0.5);
        const Eigen::Vector3f place = (sample_to_world(grid, sample) - middle).cast<float>();
        points.push_back({place[0], place[1], place[2], 0});
      }
      gpu::compensated_ray_marching::Definitions definitions = density.definitions();
      definitions.insert(
          {{"AT_DENSITY", std::to_string(int(gpu::compensated_ray_marching::at::density))}, {"LOCAL_SIZE_X", "64"}});
      gpu::Program program(context, "test.comp", definitions);
      const Buffer places(context, "points", points), result(context, "result", 4 * points.size());
      density.bind(program);
      places.bind(1);
      result.bind(2);
      program.set("count", int(points.size()));
      program.dispatch(int(points.size()));
      const std::vector<float> got = result.download<float>();
      CAPTURE(v.at("id").get<std::string>(), clamped);
      // Places of up to 5 samples, rounded to 2^-23 of 8; densities of 1.5, and differences of as much from voxel to voxel along three axes.
      for (std::size_t i = 0; i < points.size(); ++i)
        CHECK(std::abs(got[i] - number(expected[i])) <= 3 * 1.5 * 8 * std::exp2(-23));
    }
}

DEVICE_TEST_CASE("harmonics on the device are the oracle's", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const gpu::test::ShaderFolder shaders(R"(layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/spherical_harmonics.glsl"
layout(std430, binding = 1) writeonly buffer Result { float result[]; };
uniform vec3 w;
void main() {
  for (ShPair y = first_pair(w); y.m < sh_order; next_pair(y, w)) {
    result[y.l * (y.l + 1) - y.m] = y.minus;
    result[y.l * (y.l + 1) + y.m] = y.plus;
  }
}
)");
  for (const json& v : of_kind("sh_basis")) {
    const int order = v.at("input").at("order");
    gpu::Program program(context, "test.comp", {{"LOCAL_SIZE_X", "1"}});
    const Buffer result(context, "result", 4 * std::size_t(order * order));
    result.bind(1);
    program.set("sh_order", order);
    program.set("w", vec(v.at("input").at("direction")).normalized());
    program.dispatch(1);
    const std::vector<float> got = result.download<float>();
    REQUIRE(got.size() == v.at("expected").size());
    // Some ten products of numbers up to 2, each rounded to 2^-24.
    for (std::size_t i = 0; i < got.size(); ++i)
      CHECK(std::abs(got[i] - number(v.at("expected")[i])) <= 20 * std::exp2(-24) + 2 * gpu::test::injected_error());
  }
}

// The march itself, of a source radiance that is given: one ray through a voxel that is all the smoke.
DEVICE_TEST_CASE("slices of even smoke on the device add up to the oracle's sums",
                 "[gpu][compensated_ray_marching][thorough]") {
  const gpu::Use use(context);
  for (const json& v : of_kind("ray_march_homogeneous")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const double slice = number(in.at("step")), length = slice * number(in.at("slices")), J = number(in.at("J"));
    scene::VoxelGrid grid;
    grid.size = Vector3i::Ones();
    grid.voxel_size = length;
    grid.values = {float(number(in.at("D")))};
    grid.clamp_border = true;
    const scene::Medium medium = medium_of(grid, number(in.at("sigma_t")));
    const compensated_ray_marching::SmokeField field(medium, {});
    const gpu::compensated_ray_marching::SmokeDensity density(context, field, Point3::Zero(), false);
    scene::View view{scene::look_at({0, 0, 2 * length}, {0, 0, 0}, Vec3::UnitY()), 1, 1};
    const Buffer ranges(context, "ranges", 16), airlight(context, "airlight", 12), column(context, "column", 4),
        logarithms(context, "logarithms", std::vector<float>(4, float(std::log(J))));
    using namespace gpu::compensated_ray_marching;
    gpu::Program& find = program(context, "ranges", 8, 8, density.definitions());
    auto definitions = density.definitions();
    definitions["SCATTERS"] = "1";
    gpu::Program& march = program(context, "march", 8, 8, definitions);
    for (const auto& [weight, name] : {std::pair(0, "paper_sum_without_background"), {1, "exact_without_background"}}) {
      CAPTURE(v.at("id").get<std::string>(), name);
      using compensated_ray_marching::SliceWeight;
      ranges.bind(at::ranges);
      airlight.bind(at::airlight_layer);
      column.bind(at::column);
      ranges.bind(at::distances);
      set_camera(find, view);
      density.bind(find);
      find.set("has_ends", false);
      find.set("slice", slice * (1 + 1e-6));  // the length is a whole number of them but for its rounding
      find.set("widths2", density.widths2());
      find.dispatch(1, 1);
      CHECK(ranges.download<float>().at(2) == number(in.at("slices")));
      logarithms.bind(at::logarithms);
      set_camera(march, view);
      density.bind(march);
      march.set("corner", Vec3(Vec3::Constant(-0.5 * length)));
      march.set("cell_edge", length);
      march.set("brightest", Rgb(Rgb::Constant(1e37)));
      march.set("cells_along", Vec3(Vec3::Ones()));
      march.set("sigma_t", medium.sigma_t);
      march.set("weight", int(weight == 0 ? SliceWeight::paper : SliceWeight::exact));
      for (int first = 0; first < number(in.at("slices")); first += density.slices()) {
        march.set("first_slice", first);
        march.dispatch(1, 1);
      }
      const double depth = number(in.at("sigma_t")) * column.download<float>().at(0),
                   light = airlight.download<float>().at(0);
      // A hundred sums, of which each is rounded to 2^-24 of the whole; depths of as many 2^-24 in the exponential.
      const double rounding = 100 * std::exp2(-24) + 2 * gpu::test::injected_error();
      CHECK(std::abs(std::exp(-depth) - number(expected.at("transmittance"))) <=
            (1 + depth) * rounding * number(expected.at("transmittance")));
      CHECK(std::abs(light - number(expected.at(name))) <= 2 * rounding * number(expected.at(name)));
    }
  }
}

}  // namespace kernel_vectors_test
