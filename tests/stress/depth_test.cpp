// Stress cases 1 to 5 and 14: optical depths from 1e-8 to 1e6.
#include "tests/oracle_vectors.h"
#include "tests/stress/stress.h"

namespace depth_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

const Box unit{{0, 0, 0}, {1, 1, 1}};

// The layer 0 <= y <= 1 under a white sky, seen straight down from above. With `lid`, what comes back up is lost, so
// that the answer is the transmittance instead of the sum.
std::shared_ptr<scene::Scene> slab(double tau, double albedo, bool lid) {
  std::vector<scene::Surface> surfaces;
  if (lid) surfaces.push_back({"lid", scene::Plane{{0, 3, 0}, Vec3::UnitY()}, scene::Lambert{Rgb::Zero()}});
  return scene_of({medium(scene::Slab{Vec3::UnitY(), 0, 1}, tau, albedo)}, {white()}, surfaces);
}
const Ray down{{0, 2, 0}, -Vec3::UnitY()};

}  // namespace

// L1 = albedo p E tau (1 - O(tau)): at tau = 1e-8 the two transmittances take at most 2e-8 of it, the quadrature 1e-10.
TEST_CASE("stress 01: tau 1e-8", "[stress]") {
  const double tau = 1e-8, albedo = 0.7, E = 3;
  auto scene = scene_of({medium(unit, tau, albedo)}, {scene::DirectionalLight{Vec3::UnitY(), Rgb::Constant(E)}});
  scene->ambient_in_scatter = Rgb::Constant(2);
  const Ray ray{{0.5, 0.5, 3}, -Vec3::UnitZ()};
  const double expected = albedo * E * tau / (4 * pi);
  const auto exact = deterministic::airlight(*scene, ray, infinity);
  CHECK(exact.converged);
  CHECK(std::abs(exact.radiance[0] / expected - 1) < 3e-8);

  scene::View view;
  view.camera = scene::look_at(ray.origin, {0.5, 0.5, 0.5}, Vec3::UnitY());
  view.width = view.height = 1;
  // Stored as float: 6e-8.
  const scene::Film truth = picture("deterministic", scene, view);
  CHECK(truth.get("airlight", 0, 0)[0] == Approx(expected).epsilon(1e-7));
  // 1 - exp(-tau) would be 0 or off by 1e-8 of tau's 1e-8.
  CHECK(truth.get("ambient", 0, 0)[0] == Approx(2 * tau).epsilon(1e-7));
  CHECK(truth.get("transmittance", 0, 0)[0] == 1);
  // 64 float terms, each good to a few 6e-8, and the sum to 64 of them at the very most.
  for (const char* const name : {"ray_marcher", "froxel_fog", "half_resolution_march"}) {
    CAPTURE(name);
    CHECK(picture(name, scene, view).get("airlight", 0, 0)[0] == Approx(expected).epsilon(4e-6));
  }

  // A point light is met on every path: the path tracer sees it too. With it in the middle of the box the order is
  // (1, 0) up to tau.
  auto lit = scene_of({medium(unit, tau, albedo)}, {scene::PointLight{{0.5, 0.9, 0.5}}});
  const auto quadrature = deterministic::airlight(*lit, ray, infinity);
  Options options;
  const auto traced = radiance(World(lit, options), ray, 1 << 14);
  // The walk's own collisions (eight tries: once in 1e7 paths) carry a share of up to 8 tau, and are not met here.
  const Estimate& first = traced.orders[1];
  CHECK(std::abs(first.mean[0] / quadrature.radiance[0] - 1) <=
        limit * first.error[0] / quadrature.radiance[0] + 9 * tau);
  CHECK(first.error[0] < 0.02 * quadrature.radiance[0]);
  CHECK(traced.orders[2].mean[0] <= 1e-6 * traced.orders[1].mean[0]);
}

// Thin: L1 = p E tau with tau the sum of the single depths, up to tau = 1e-4 itself; and the depth is that sum.
TEST_CASE("stress 02: a million Gaussians far away, tau 1e-4 together", "[stress]") {
  const int n = 1000000;
  scene::GaussianSum sum;
  sum.gaussians.reserve(n);
  const Ray ray = ray_of({0, 0, 0}, {0.001, -0.0005, 1});
  double total = 0;
  for (int i = 0; i < n; ++i) {
    const RandomBlock u = SampleRandom(3, 1, 0, i).block(0, Purpose::camera);
    const Point3 center(20 * u.coarse(0) - 10, 20 * u.coarse(1) - 10, 1e4 + 20 * u.coarse(2) - 10);
    sum.gaussians.push_back({center, 1 + u.coarse(3), 1});
    total += scene::line_integral(sum.gaussians.back(), ray, infinity);
  }
  const double sigma = 1e-4 / total;
  const auto scene =
      scene_of({of_field(sum, sigma, 1)}, {scene::DirectionalLight{Vec3::UnitY(), Rgb::Constant(4 * pi)}});
  // Tolerance of the integrator 1e-10, of which 1e-3 is for what it skips; a million roundings of 1e-16.
  const deterministic::AirlightIntegrator integrator(*scene, {});
  CHECK(integrator.optical_depth(ray, infinity)[0] == Approx(1e-4).epsilon(1e-9));
  CHECK(scene::optical_depth(scene->media, ray, {0, infinity})[0] == Approx(1e-4).epsilon(1e-9));
  // The airlight of the first thousand, each of them alone or all at once: one scattering in thin air is linear, but
  // for the two transmittances, of less than 1e-4 together as there are so few.
  sum.gaussians.resize(1000);
  const auto few = scene_of({of_field(sum, sigma, 1)}, scene->lights);
  double alone = 0;
  for (const scene::Gaussian& g : sum.gaussians) alone += sigma * scene::line_integral(g, ray, infinity);
  const auto airlight = deterministic::airlight(*few, ray, infinity);
  CHECK(airlight.converged);
  CHECK(airlight.radiance[0] == Approx(alone).epsilon(1e-4));
  CHECK(airlight.radiance[0] < alone);
}

TEST_CASE("stress 03: tau 1e3, albedo 1", "[stress]") {
  // The asymptote of thick slabs against the table, both with eight digits.
  const double H = airlight::test::vector_of("halfspace-H").at("expected").at("H").at("1.0").at("1");
  const auto asymptote = [](double tau) { return 1 / (std::sqrt(3.0) * (tau + 1.42089)); };
  bool found = false;
  for (const auto& row : airlight::test::vector_of("slab-table").at("expected").at("rows"))
    if (row[0] == "iso" && row[2] == 1.0 && row[3] == 100.0) {
      found = true;
      CHECK(row[4].get<double>() + row[5].get<double>() == Approx(1).margin(1e-7));
      CHECK(row[5].get<double>() == Approx(H * asymptote(100)).margin(3e-7));
      CHECK(row[11].get<double>() == Approx(4.0 / 3 / (100 + 1.42089)).margin(3e-7));
    }
  CHECK(found);
  // R + T = 1, by the path tracer at tau 1e3 (some thousand collisions a path).
  const auto both = radiance(World(slab(1e3, 1, false), Options{}), down, 512, {}, 31);
  check_equal(1, both.total, 0.05);
  CHECK(double(both.counters.collisions) > 500.0 * double(both.samples));
  // T alone where enough of it comes through.
  const auto through = radiance(World(slab(100, 1, true), Options{}), down, 1 << 14, {}, 32);
  check_equal(H * asymptote(100), through.total, 0.1);
}

// Light that a half space reflects; at tau 1e6 the slab transmits nothing.
TEST_CASE("stress 04: tau 1e6, albedo 0.999", "[stress]") {
  const double expected = airlight::test::vector_of("halfspace-H").at("expected").at("albedo_mu1").at("0.999");
  const auto back = radiance(World(slab(1e6, 0.999, false), Options{}), down, 1 << 16, {}, 41);
  check_equal(expected, back.total, 0.004);
  CHECK(back.orders[0].mean[0] == 0);
}

TEST_CASE("stress 05: tau 1e6, albedo 1, is refused or capped with `truncated` reported", "[stress]") {
  const auto scene = slab(1e6, 1, false);
  const auto reasons = stress::refusals("path_tracer", *scene);
  REQUIRE(reasons.size() == 1);
  CHECK_THAT(reasons.front(), Catch::Contains("1e+06 optical depths") && Catch::Contains("max_order"));
  CHECK_THROWS_AS(picture("path_tracer", scene, view_from({0, 2, 0}, {0.3, 0, 0.2}, 2)), Error);
  // Capped, what the cap threw away is in its own layer: with the rest it makes 1 (the furnace).
  const scene::Film film =
      picture("path_tracer", scene, view_from({0, 2, 0}, {0.3, 0, 0.2}, 2), {{"max_order", "50"}, {"samples", "4096"}});
  CHECK(all_finite(film));
  for (int x = 0; x < 2; ++x) {
    const double mean = film.get("mean", x, 0)[0], truncated = film.get("truncated", x, 0)[0];
    const double error = film.get("se", x, 0)[0];
    CAPTURE(mean, truncated, error);
    CHECK(truncated > 0.05);
    // A path is truncated or not: its share has a standard error of at most 0.5 / sqrt(n).
    CHECK(std::abs(mean + truncated - 1) < limit * (error + 0.5 / 64));
  }
}

TEST_CASE("stress 14: camera deep in a medium, 50 optical depths from what it sees", "[stress]") {
  const scene::Medium dense = medium(scene::Sphere{{0, 0, 0}, 1}, 50, 0.5);
  const Ray ray = ray_of({0, 0, 0}, {0.6, 0, 0.8});
  Options options;
  const auto traced = radiance(World(scene_of({dense}, {white()}), options), ray, 4096);
  CHECK(traced.orders[0].mean[0] == Approx(std::exp(-50.0)).epsilon(1e-13));
  CHECK(traced.total.mean.allFinite());
  // A light 50 optical depths away: scattered on the way, finite and positive, nowhere lost to a 24-bit uniform.
  for (const scene::Light& light : {scene::Light(scene::PointLight{{0.6, 0, 0.8}}),
                                    scene::Light(scene::DirectionalLight{{0.6, 0, 0.8}, Rgb::Ones()})}) {
    const auto scene = scene_of({dense}, {light});
    const auto exact = deterministic::airlight(*scene, ray_of({0, 0, 0}, {0, 1, 0}), infinity);
    CHECK(exact.converged);
    CHECK((exact.radiance > 0 && exact.radiance < 1e-15).all());
    CHECK(radiance(World(scene, options), ray_of({0, 0, 0}, {0, 1, 0}), 1024).total.mean.allFinite());
  }
  auto view = view_from({0, 0, 0}, {0.6, 0, 0.8}, 3);
  for (const char* const name : renderers) {
    const scene::Film film = picture(name, scene_of({dense}, {white(), scene::PointLight{{0, 0.5, 0}}}), view);
    CHECK(all_finite(film));
    // Fitted froxels end where a ray is 16 deep.
    const double through = film.get("transmittance", 1, 1)[0];
    if (std::string(name) == "froxel_fog")
      CHECK((through > 0 && through < 1.01 * std::exp(-16.0)));
    else
      CHECK(through == Approx(std::exp(-50.0)).epsilon(1e-5));
  }
}

}  // namespace depth_test
