// Stress cases 18, 19 and 21 to 26: densities at the edge of what a density can be.
#include "methods/wavelet_fog/leveled_fog.h"
#include "scene/base/stopwatch.h"
#include "scene/math/legendre.h"
#include "scene/math/random.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"
#include "tests/stress/stress.h"

namespace field_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

scene::VoxelGrid grid_of(int n, const std::vector<float>& values) {
  scene::VoxelGrid grid;
  grid.size = Eigen::Vector3i::Constant(n);
  grid.voxel_size = 0.5;
  grid.values = values;
  return grid;
}

const std::vector<scene::Light> lamps = {scene::PointLight{{0.4, 1.4, 0.3}}, scene::DirectionalLight{}, white()};

}  // namespace

TEST_CASE("stress 18: NaN, infinite, minus zero and subnormal voxels", "[stress]") {
  const auto load = [](const std::string& value) {
    return scene::parse_scene(
        "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n[[medium]]\ntype = \"grid\"\n"
        "size = [2, 2, 1]\nvoxel_size = 1.0\norigin = [0, 0, 0]\nvalues = [0.5, 1.0, " +
            value + ", 0.25]\n",
        "voxels", ".");
  };
  for (const char* const value : {"nan", "inf", "-1.0", "1e300"}) {
    CAPTURE(value);
    // Line 9, third value.
    CHECK_THROWS_WITH(load(value), Catch::Contains("voxels:9:"));
  }
  for (const char* const value : {"-0.0", "1e-45", "1e-310"}) CHECK_NOTHROW(load(value));
  // Like 0 in every picture.
  const auto view = view_from({0.3, 0.4, 3}, {0.25, 0.25, 0.25});
  for (const char* const name : renderers) {
    const Given given = std::string(name) == "path_tracer" ? Given{{"samples", "64"}} : Given{};
    const scene::Film zero =
        picture(name, scene_of({of_grid(grid_of(2, {1, 0, 0, 1, 0, 1, 1, 0}), 2, 0.9)}, lamps), view, given);
    const scene::Film odd = picture(
        name, scene_of({of_grid(grid_of(2, {1, -0.0f, 1e-45f, 1, -0.0f, 1, 1, 1e-40f}), 2, 0.9)}, lamps), view, given);
    CAPTURE(name);
    CHECK(all_finite(odd));
    CHECK(odd.layer("mean") == zero.layer("mean"));
  }
}

TEST_CASE("stress 19: renderers on an empty grid, one voxel, one active voxel", "[stress]") {
  std::vector<float> one_active(27, 0.0f);
  one_active[13] = 0.75f;
  scene::VoxelGrid single = grid_of(1, {0.75f});
  single.translation = Vec3::Constant(0.5);
  const auto view = view_from({0.5, 0.5, 3}, {0.5, 0.5, 0.5}, 3);
  for (const char* const name : renderers) {
    const Given given = std::string(name) == "path_tracer" ? Given{{"samples", "256"}} : Given{};
    CAPTURE(name);
    const scene::Film nothing = picture(name, scene_of({of_grid(scene::VoxelGrid{}, 2, 1)}, lamps), view, given);
    CHECK(all_finite(nothing));
    CHECK(nothing.get("transmittance", 1, 1)[0] == 1);
    if (nothing.has("airlight")) CHECK(nothing.get("airlight", 1, 1)[0] == 0);
    const scene::Film a = picture(name, scene_of({of_grid(single, 2, 1)}, lamps), view, given);
    const scene::Film b = picture(name, scene_of({of_grid(grid_of(3, one_active), 2, 1)}, lamps), view, given);
    // A tent of one voxel to either side: its area is value times voxel. The ray marcher's midpoints are exact on the
    // two straight halves of it up to one step of 64 at the kink: 2^-12 of a depth of 0.75.
    const double exact = std::exp(-2 * 0.75 * 0.5);
    const bool steps = std::string(name) != "path_tracer" && std::string(name) != "deterministic";
    CHECK(a.get("transmittance", 1, 1)[0] == Approx(exact).epsilon(steps ? 2e-4 : 1e-6));
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        CHECK(b.get("transmittance", x, y)[0] == Approx(a.get("transmittance", x, y)[0]).epsilon(steps ? 1e-3 : 1e-6));
    CHECK(all_finite(b));
  }
}

TEST_CASE("stress 21: renderers add overlapping media", "[stress]") {
  // 1.2 of albedo 0.9 and 0.8 of albedo 0.6 make 2 of albedo 0.78.
  const scene::Region ball = scene::Sphere{{0, 0, 0}, 1};
  const auto two = scene_of({medium(ball, 1.2, 0.9), medium(ball, 0.8, 0.6)}, lamps);
  const auto one = scene_of({medium(ball, 2, 0.78)}, lamps);
  const auto view = view_from({0.2, 0.3, 3}, {0, 0, 0});
  for (const char* const name : biased_renderers) {
    const scene::Film a = picture(name, two, view), b = picture(name, one, view);
    CAPTURE(name);
    for (std::size_t i = 0; i < a.layer("mean").size(); ++i)
      CHECK(a.layer("mean")[i] == Approx(b.layer("mean")[i]).epsilon(1e-5).margin(1e-12));
  }
  const auto a = radiance(World(two, Options{}), ray_of({0.2, 0.3, 3}, {0, 0, -1}), 1 << 14, {}, 211);
  const auto b = radiance(World(one, Options{}), ray_of({0.2, 0.3, 3}, {0, 0, -1}), 1 << 14, {}, 212);
  CHECK(a.orders[0].mean[0] == Approx(b.orders[0].mean[0]).epsilon(1e-13));
  Rgb sum = Rgb::Zero();
  for (const auto& order : a.orders) sum += order.mean;
  CHECK(sum[0] == Approx(a.total.mean[0]).epsilon(1e-12));
  for (int m = 1; m <= 3; ++m)
    check_equal(b.orders[m].mean[0], a.orders[m].mean[0], std::hypot(a.orders[m].error[0], b.orders[m].error[0]), 0.1);
}

TEST_CASE("stress 22: a Legendre field that is negative everywhere", "[stress]") {
  // Down to -1 in the middle, up to 0 at two faces, touched: nothing there for anyone, whatever the extinction.
  const auto box_of = [](double constant) {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(3);
    f[0] = (constant + 1.0 / 3) * std::sqrt(8.0);  // u^2 + constant, u^2 = (1 + 2 P_2) / 3
    f[2] = 2.0 / 3 * std::sqrt(0.4) * 2;
    return std::make_shared<const scene::LegendreBox>(Box{Point3::Constant(-1), Point3::Constant(1)},
                                                      scene::TensorShape{3, 1, 1}, f);
  };
  const auto view = view_from({0.3, 0.4, 4}, {0, 0, 0});
  const auto vacuum = scene_of({}, lamps);
  for (const double constant : {-1.5, -1 - 1e-6}) {
    const auto negative = scene_of({of_field(scene::LegendrePointer(box_of(constant)), 1e6, 0.9)}, lamps);
    CHECK(scene::density(negative->media[0], {0.9, 0.1, 0}) == 0);
    CHECK(scene::density_bounds(negative->media[0], {Point3::Constant(-9), Point3::Constant(9)}).hi == 0);
    CHECK(scene::optical_depth(negative->media, {{-5, 0, 0}, Vec3::UnitX()}, {0, infinity})[0] == 0);
    CHECK(scene::bounding_box(negative->media[0]).empty());
    for (const char* const name : renderers) {
      const Given given = std::string(name) == "path_tracer" ? Given{{"samples", "64"}} : Given{};
      CAPTURE(name, constant);
      const scene::Film film = picture(name, negative, view, given);
      CHECK(all_finite(film));
      CHECK(film.layer("mean") == picture(name, vacuum, view, given).layer("mean"));
      CHECK(film.get("transmittance", 2, 2)[0] == 1);
    }
  }
  // A tenth above 0 at those two faces: a film of fog, which rays through them see as its closed form.
  const auto film = box_of(-0.9);
  const double root = std::sqrt(0.9), depth = 2 * ((1 - root * root * root) / 3 - 0.9 * (1 - root));
  CHECK(scene::density_integral(*film, {{-5, 0.2, 0.1}, Vec3::UnitX()}, {0, infinity}) == Approx(depth).epsilon(1e-10));
}

TEST_CASE("stress 23: Legendre degree 23 per axis", "[stress]") {
  // L_23 along each axis over a constant that leaves it negative in places: its waves are a 25th of the box at the faces.
  constexpr int n = 24;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n * n * n);
  f[0] = std::sqrt(8.0);
  f[n * n * n - 1] = 0.5;
  f[(23 * n + 0) * n + 5] = 0.3;
  const auto box = std::make_shared<const scene::LegendreBox>(Box{Point3::Constant(-1), Point3::Constant(1)},
                                                              scene::TensorShape{n, n, n}, f);
  CHECK(box->negative());
  // At a corner every function is at its greatest.
  const double corner = 1 + 0.5 * std::pow(23.5, 1.5) + 0.3 * std::sqrt(23.5 * 0.5 * 5.5);
  CHECK(scene::density(*box, {1, 1, 1}) == Approx(corner).epsilon(1e-12));
  CHECK(box->greatest() == Approx(corner).epsilon(0.02));
  // Integrals against sums of a hundred thousand places, along diagonals and axes.
  for (const auto& [p, q] : {std::pair<Point3, Point3>{{-1, -1, -1}, {1, 1, 1}},
                             {{-1.2, 0.9, 0.3}, {1.1, -0.99, 0.97}},
                             {{0.31, -2, 0.98}, {0.31, 2, 0.98}}}) {
    const double length = (q - p).norm();
    const Ray ray{p, (q - p) / length};
    double sum = 0;
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) sum += scene::density(*box, ray.at((i + 0.5) / steps * length));
    CHECK(scene::density_integral(*box, ray, {0, length}) == Approx(sum * length / steps).epsilon(1e-3));
  }
  // The quadrature against steps, and against light that is drawn.
  const auto world = scene_of({of_field(scene::LegendrePointer(box), 0.8, 0.9)},
                              {scene::DirectionalLight{Vec3(1, 2, 1).normalized(), Rgb::Ones()}});
  const Ray ray = ray_of({0.3, 0.4, 5}, {-0.3, -0.4, -5});
  const double once = deterministic::airlight(*world, ray, infinity, {1e-4, 4000}).radiance[0];
  const scene::Film marched =
      picture("ray_marcher", world, view_from(ray.origin, {0, 0, 0}, 1), {{"steps", "256"}, {"shadow", "exact"}});
  CHECK(marched.get("transmittance", 0, 0)[0] ==
        Approx(scene::transmittance(world->media, ray, {0, infinity})[0]).epsilon(1e-3));
  CHECK(marched.get("mean", 0, 0)[0] == Approx(once).epsilon(2e-3));
  Options once_scattered;
  once_scattered.max_order = 1;
  const auto drawn = radiance(World(world, once_scattered), ray, 1 << 11, {}, 231);
  check_equal(once, drawn.orders[1].mean[0], drawn.orders[1].error[0], 0.1);
}

TEST_CASE("stress 24: a fogmap of 4096 x 4096 with a single spike", "[stress]") {
  // One coefficient of degree 1 on cells of 1 m, 4 m high: upright through its top the depth is 4, beside it 0. The other
  // map holds next to nothing at the same place: as empty as a map can be that is not left out.
  constexpr int side = 4096, at = 2500;
  std::vector<double> values(std::size_t(side) * side, 0.0);
  const auto spike = [&](double height) {
    values[std::size_t(at) * side + at] = height;
    auto fog = std::make_shared<scene::Fogmap>();
    fog->map = scene::SplineMap(1, {{0, 0}, {side, side}}, values);
    return of_field(scene::FogmapPointer(fog), 1, 0.8, scene::Slab{Vec3::UnitY(), 0, 4});
  };
  const auto needle = scene_of({spike(1)}, {scene::DirectionalLight{Vec3::UnitY(), Rgb::Ones()}});
  const auto empty = scene_of({spike(1e-30)}, needle->lights);
  const double top = at + 1;
  const Ray down{{top, 10, top}, -Vec3::UnitY()};
  CHECK(scene::optical_depth(needle->media, down, {0, infinity})[0] == Approx(4).epsilon(1e-14));
  CHECK(scene::optical_depth(needle->media, {{top + 1, 10, top}, -Vec3::UnitY()}, {0, infinity})[0] == 0);
  // Across the whole map through the top: the triangle's area, 1. Along a diagonal of its cells, sqrt(2) 2/3.
  const Ray across{{-10, 2, top}, Vec3::UnitX()}, diagonal{{top - 1700, 2, top - 1700}, Vec3(1, 0, 1).normalized()};
  const Ray beside{{-10, 2, top + 20}, Vec3::UnitX()};
  CHECK(scene::optical_depth(needle->media, across, {0, infinity})[0] == Approx(1).epsilon(1e-12));
  CHECK(scene::optical_depth(needle->media, diagonal, {0, infinity})[0] ==
        Approx(std::sqrt(2.0) * 2 / 3).epsilon(1e-11));
  CHECK(scene::optical_depth(needle->media, beside, {0, infinity})[0] == 0);
  // Light and view along one line: (1 - exp(-2 depth)) / 2 as in case 25.
  const double expected = 0.8 / (4 * pi) * 0.5 * (1 - std::exp(-8.0));
  const auto exact = deterministic::airlight(*needle, down, infinity);
  CHECK(exact.converged);
  CHECK(exact.radiance[0] == Approx(expected).epsilon(1e-8));
  const World world(needle, Options{}), vanishing(empty, Options{});
  const auto traced = radiance(world, down, 1 << 14, {}, 241);
  check_equal(expected, traced.orders[1], 0.05);
  CHECK(traced.counters.violations == 0);

  // The supergrid skips what is empty: no collision is looked for beside the spike, and few around it.
  const auto missed = radiance(world, beside, 4096, {}, 242), slow = radiance(vanishing, across, 4096, {}, 243);
  const auto met = radiance(world, across, 4096, {}, 244);
  CHECK(missed.counters.lookups == 0);
  CHECK(missed.orders[1].mean[0] == 0);
  CHECK(slow.counters.lookups < 64 * slow.samples);
  CHECK(met.counters.lookups < 64 * met.samples);

  // The method's empty blocks: eight cells at a time, and a handful of cells are read.
  wavelet_fog::Options options;
  const wavelet_fog::LeveledFog fog(needle->media[0], options);
  for (const Ray& ray : {across, diagonal, beside}) {
    wavelet_fog::Visits visits;
    CHECK(fog.column(ray, infinity, visits) ==
          Approx(scene::optical_depth(needle->media, ray, {0, infinity})[0]).epsilon(1e-12));
    CHECK(visits.cells <= 4);
  }
  // Within twice the time of the empty map: the fastest of five, in turns.
  double fastest[2] = {infinity, infinity};
  for (int run = 0; run < 5; ++run)
    for (int which = 0; which < 2; ++which) {
      scene::Stopwatch watch;
      radiance(which ? world : vanishing, across, 2048, {}, 245 + run);
      fastest[which] = std::min(fastest[which], watch.lap());
    }
  CAPTURE(fastest[0], fastest[1]);
  if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("spike {:.3g} s, empty {:.3g} s\n", fastest[1], fastest[0]);
  CHECK(fastest[1] <= 2 * fastest[0]);
}

TEST_CASE("stress 25: renderers on a Gaussian spike and a flat one", "[stress]") {
  // a = 1/width. The spike is 1e-6 wide and sqrt(pi) deep where the ray meets its middle, and not there beside it.
  scene::GaussianSum spike;
  spike.gaussians = {{{0.1, 0.2, 0}, 1e-6, 1e6}};
  const auto needle = scene_of({of_field(spike, 1, 0.8)}, {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Ones()}});
  const Ray through{{0.1, 0.2, 3}, -Vec3::UnitZ()}, beside{{0.1 + 1e-4, 0.2, 3}, -Vec3::UnitZ()};
  const double depth = std::sqrt(pi);
  CHECK(scene::optical_depth(needle->media, through, {0, infinity})[0] == Approx(depth).epsilon(1e-9));
  CHECK(scene::optical_depth(needle->media, beside, {0, infinity})[0] == 0);
  // Light and view along one line: the airlight is the integral of exp(-2 tau), (1 - exp(-2 depth)) / 2.
  const double expected = 0.8 / (4 * pi) * 0.5 * (1 - std::exp(-2 * depth));
  const auto exact = deterministic::airlight(*needle, through, infinity);
  CHECK(exact.converged);
  CHECK(exact.radiance[0] == Approx(expected).epsilon(1e-8));
  CHECK(deterministic::airlight(*needle, beside, infinity).radiance[0] == 0);
  const auto traced = radiance(World(needle, Options{}), through, 1 << 14, {}, 251);
  check_equal(expected, traced.orders[1], 0.05);
  CHECK(traced.counters.violations == 0);

  // 1e6 wide over a box of 1: a constant up to 1e-12.
  scene::GaussianSum flat;
  flat.gaussians = {{{0, 0, 0}, 1e6, 1}};
  const Box box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  const auto smooth = scene_of({of_field(flat, 2, 0.8, box)}, lamps), constant = scene_of({medium(box, 2, 0.8)}, lamps);
  const Ray ray = ray_of({0.1, 0.2, 3}, {0, 0, -1});
  CHECK(scene::optical_depth(smooth->media, ray, {0, infinity})[0] == Approx(2).epsilon(1e-11));
  const double one = deterministic::airlight(*constant, ray, infinity).radiance[0];
  CHECK(deterministic::airlight(*smooth, ray, infinity).radiance[0] == Approx(one).epsilon(2e-10));
  const auto tracked = radiance(World(smooth, Options{}), ray, 1 << 13, {}, 252);
  const auto free = radiance(World(constant, Options{}), ray, 1 << 13, {}, 253);
  check_equal(free.total.mean[0], tracked.total.mean[0], std::hypot(free.total.error[0], tracked.total.error[0]), 0.05);
}

// A bound that sums a hundred thousand maxima holds, and the work is that of the sum.
TEST_CASE("stress 26: paths through 1e5 Gaussians in one cell", "[stress]") {
  scene::GaussianSum sum;
  for (int i = 0; i < 100000; ++i) {
    const RandomBlock u = SampleRandom(7, 1, 0, i).block(0, Purpose::camera);
    sum.gaussians.push_back({Point3(u.coarse(0), u.coarse(1), u.coarse(2)) * 0.01, 0.05 + 0.05 * u.coarse(3), 1e-5});
  }
  const auto scene = scene_of({of_field(sum, 10, 1, scene::Sphere{{0, 0, 0}, 0.3})}, {white()});
  Options options;
  options.supergrid_cells = 4;
  const World world(scene, options);
  const auto e = radiance(world, ray_of({0.01, 0.02, -1}, {0, 0, 1}), 256, {}, 261);
  check_equal(1, e.total, 0.1);
  CHECK(e.counters.violations == 0);
  // Delta tracking looks up the density a few times per collision, not more: the bound of a cell is that of its
  // nearest points, here at most exp(2 * 0.26 * 0.15 / 0.05^2) but for the widest Gaussians; without a bound that
  // adapts it would be hundreds of times.
  CHECK(e.counters.lookups < 100 * (e.counters.collisions + e.counters.paths));
}

}  // namespace field_test
