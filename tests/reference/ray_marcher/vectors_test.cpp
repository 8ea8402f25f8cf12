// Single scattering against the oracle vectors of tests/vectors/references.json, and the order at which it is reached.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/oracle_vectors.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace vectors_test {

using namespace airlight;
using namespace airlight::ray_marcher;
using airlight::test::json;
using airlight::test::vec;

namespace {

scene::PhaseFunction phase_of(const json& j) {
  const std::string name = j.at("name");
  if (name == "hg") return scene::HenyeyGreenstein{j.at("g").get<double>()};
  if (name == "rayleigh") return scene::Rayleigh{};
  if (name == "hazy") return scene::Hazy{};
  if (name == "murky") return scene::Murky{};
  REQUIRE(name == "isotropic");
  return scene::Isotropic{};
}

scene::Region region_of(const json& shape) {
  if (shape.at("type") == "sphere") return scene::Sphere{Point3::Zero(), shape.at("R").get<double>()};
  return Box{vec(shape.at("lo")), vec(shape.at("hi"))};
}

scene::Light light_of(const json& j) {
  if (j.at("type") == "point") return scene::PointLight{vec(j.at("pos")), Rgb::Constant(j.at("I").get<double>()), 0};
  return scene::DirectionalLight{vec(j.at("to_light")).normalized(), Rgb::Constant(j.at("E").get<double>())};
}

// Error over error with half the steps, as the exponent of the step length; NaN-free since errors are positive.
double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

// Shadow columns are exact in a homogeneous medium and the cuts are at the region's ends, so the camera march is a
// midpoint rule of a smooth function: order 2, seen as a ratio of errors. At 256 and 512 steps the next term is h^2
// smaller than the leading one (relative 1e-3 where the light is a few steps away): the slope is within 0.05 of 2.
// Errors below 1e-8 relative feel the vectors' own 1e-10 and are not asked for a slope.
TEST_CASE("ray marcher: homogeneous media: oracle vectors are reached at order 2", "[ray_marcher]") {
  int seen = 0;
  for (const json& v : airlight::test::vectors_in("references")) {
    if (v.at("kind") != "single_scattering_sphere" && v.at("kind") != "single_scattering_box") continue;
    const json& in = v.at("input");
    const auto scene = make_scene(
        {make_medium(scene::Homogeneous{1}, region_of(in.at("shape")), Rgb::Constant(in.at("sigma_t").get<double>()),
                     Rgb::Constant(in.at("albedo").get<double>()), phase_of(in.at("phase")))},
        {light_of(in.at("light"))});
    const Ray ray{vec(in.at("o")), vec(in.at("d")).normalized()};
    const double expected = v.at("expected").at("L1");
    const auto error = [&](int n) { return std::abs(march(scene, ray, n).airlight[0] / expected - 1); };
    // Steps short against a mean free path: the dense ones are 2 and 400 of them deep.
    const int n = std::max(256, int(40 * in.at("sigma_t").get<double>()));
    const double coarse = error(n), fine = error(2 * n);
    INFO(v.at("id") << ": relative error " << coarse << " at " << n << " steps, " << fine << " at twice as many");
    CHECK(fine < 1e-3);
    if (fine > 1e-8) CHECK(order(coarse, fine) == Approx(2).margin(0.05));
    ++seen;
  }
  CHECK(seen == 13);
}

// For sums of Gaussians both marches are midpoint rules. The view ends at a point, the light sees the unbounded medium.
// A single slope is off by a few tenths at these step counts if terms of the error cancel, or if a Gaussian is a few
// steps wide. The median over all rays is not.
TEST_CASE("ray marcher: sums of Gaussians: oracle vectors are reached at order 2", "[ray_marcher]") {
  std::vector<double> slopes;
  for (const json& v : airlight::test::vectors_in("references")) {
    if (v.at("kind") != "single_scattering_gaussians") continue;
    const json& in = v.at("input");
    scene::GaussianSum sum;
    sum.constant = in.at("b0");
    for (const json& g : in.at("gaussians"))
      sum.gaussians.push_back({vec(g.at(2)), 1 / g.at(1).get<double>(), g.at(0).get<double>()});
    std::vector<scene::Light> lights;
    for (const json& l : in.at("lights")) lights.push_back(light_of(l));
    const auto scene = make_scene({make_medium(sum, scene::Unbounded{}, Rgb::Ones(),
                                               Rgb::Constant(in.at("albedo").get<double>()), phase_of(in.at("phase")))},
                                  lights);
    for (const json& r : v.at("expected").at("rays")) {
      const Point3 eye = vec(in.at("eye")), p = vec(r.at("p"));
      const Ray ray{eye, (p - eye).normalized()};
      const double expected = r.at("L1"), depth = r.at("T");
      const auto run = [&](int n, const char* shadow) {
        return march(scene, ray, n, {{"shadow", shadow}}, (p - eye).norm());
      };
      for (const char* shadow : {"march", "exact"}) {
        const Pixel coarse = run(256, shadow), fine = run(512, shadow);
        const double e256 = std::abs(coarse.airlight[0] / expected - 1);
        const double e512 = std::abs(fine.airlight[0] / expected - 1);
        INFO(v.at("id") << " " << p.transpose() << ", shadow " << shadow << ": relative error " << e256 << ", "
                        << e512);
        // Steps are 12/512 long, the narrowest dense Gaussian (two with amplitude 20) is 0.25 wide, so 11 steps, and
        // its optical depth per step 0.5: 0.5^2/24 of the airlight that comes from there, 1e-2, times the share of
        // light of the other side, which is less than a tenth.
        CHECK(e512 < 1e-3);
        slopes.push_back(order(e256, e512));
        CHECK(slopes.back() == Approx(2).margin(0.5));
        // The midpoint sum over whole Gaussians converges faster than any power.
        CHECK(-std::log(fine.transmittance[0]) == Approx(depth).epsilon(1e-4));
      }
    }
  }
  REQUIRE(slopes.size() == 60);
  std::nth_element(slopes.begin(), slopes.begin() + 30, slopes.end());
  CHECK(slopes[30] == Approx(2).margin(0.02));
}

}  // namespace vectors_test
