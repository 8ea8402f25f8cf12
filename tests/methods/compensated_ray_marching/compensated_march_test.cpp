// The march through Gaussians and a residual: the sums over slices that the oracle lists, and the integral that they tend to.
#include "methods/compensated_ray_marching/compensated_march.h"

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "tests/oracle_vectors.h"

namespace compensated_march_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;

namespace {

MarchedSmoke smoke_of(const json& in) {
  MarchedSmoke smoke;
  smoke.extinction = Rgb::Constant(number(in.at("sigma_t")));
  smoke.gaussians.cutoff = number(in.at("cut"));
  for (const json& b : in.at("rbf_x_y_z_r_w"))
    smoke.gaussians.gaussians.push_back({vec(b), number(b[3]), number(b[4])});
  for (const json& list : in.at("source_sh_propagation")) {
    smoke.source.emplace_back();
    for (const json& c : list) smoke.source.back().push_back(Rgb::Constant(number(c)));
  }
  if (in.contains("residual")) {
    const json& values = in.at("residual").at("values_x_y_z");
    const int n = int(values.size());
    auto grid = std::make_shared<scene::VoxelGrid>();
    grid->size = Eigen::Vector3i::Constant(n);
    grid->voxel_size = 1.0 / n;
    grid->translation = Vec3::Constant(0.5 / n);
    grid->clamp_border = true;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          grid->values.push_back(float(number(values[std::size_t(i)][std::size_t(j)][std::size_t(k)])));
    smoke.residual = grid;
  }
  return smoke;
}

}  // namespace

TEST_CASE("compensated march: the oracle's sums over slices, and its integral", "[compensated_ray_marching]") {
  for (const json& v : vectors_of("compensated_ray_marching", "march_compensated")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const CompensatedMarch march(smoke_of(in));
    const Slices slices{vec(in.at("slice_axis")), number(in.at("slice_thickness")), int(number(in.at("slices")))};
    Slices fine = slices;
    fine.thickness /= 64;
    fine.count *= 64;
    const double background = number(in.at("background"));
    // A residual's values are kept in single precision.
    const double tolerance = in.contains("residual") ? 2e-7 : 1e-10;
    for (std::size_t r = 0; r < in.at("rays").size(); ++r) {
      const Ray ray{vec(in.at("rays")[r].at("origin")), vec(in.at("rays")[r].at("direction"))};
      const auto total = [&](const Slices& over, SliceWeight weight) {
        const Marched m = march.slices(ray, over, weight);
        return m.radiance[0] + m.transmittance[0] * background;
      };
      CAPTURE(v.at("id").get<std::string>(), r);
      CHECK(march.slices(ray, slices, SliceWeight::exact).transmittance[0] ==
            Approx(number(expected.at("slice_transmittance")[r])).epsilon(tolerance));
      CHECK(total(slices, SliceWeight::printed) == Approx(number(expected.at("slice_printed")[r])).epsilon(tolerance));
      CHECK(total(slices, SliceWeight::paper) == Approx(number(expected.at("slice_paper")[r])).epsilon(tolerance));
      CHECK(total(slices, SliceWeight::exact) ==
            Approx(number(expected.at("slice_exact_weight")[r])).epsilon(tolerance));
      // Slices 64 times finer, whose error is of second order but at the cuts' jumps.
      const double exact = number(expected.at("radiance")[r]);
      CHECK(total(fine, SliceWeight::exact) == Approx(exact).epsilon(2e-5));
      CHECK(std::abs(total(fine, SliceWeight::exact) - exact) <
            0.2 * std::abs(total(slices, SliceWeight::exact) - exact) + 1e-6);
    }
  }
}

TEST_CASE("compensated march: extremes", "[compensated_ray_marching]") {
  MarchedSmoke smoke;
  smoke.extinction = Rgb::Constant(1e4);
  smoke.gaussians = {{{Point3(0, 0, 1), 0.2, 1}, {Point3(0, 0, 1.1), 0.1, 0}}, 0, 3};
  smoke.source = {{Rgb::Constant(0.7 * std::sqrt(4 * pi))}, {Rgb::Constant(1e6)}};
  const Slices slices{Vec3(0, 0, 1), 0.01, 200};
  const Ray ray{Point3::Zero(), Vec3(0, 0, 1)};
  // Opaque: the source itself; a Gaussian of weight 0 counts for nothing.
  const Marched opaque = CompensatedMarch(smoke).slices(ray, slices, SliceWeight::exact);
  CHECK(opaque.transmittance[0] == 0);
  CHECK(opaque.radiance[0] == Approx(0.7));
  smoke.extinction = Rgb::Constant(1e-6);
  CHECK(CompensatedMarch(smoke).slices(ray, slices, SliceWeight::exact).transmittance[0] == Approx(1).margin(1e-5));
  // Beyond the Gaussians a residual is dropped, whatever it says.
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = Eigen::Vector3i::Constant(2);
  grid->voxel_size = 4;
  grid->values.assign(8, 1);
  smoke.residual = grid;
  const Ray aside{Point3(2, 2, 0), Vec3(0, 0, 1)};
  CHECK(CompensatedMarch(smoke).slices(aside, slices, SliceWeight::exact).transmittance[0] == 1);
  smoke.source.pop_back();
  CHECK_THROWS_AS(CompensatedMarch(smoke), Error);
}

}  // namespace compensated_march_test
