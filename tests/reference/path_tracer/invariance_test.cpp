// Properties that must not matter: threads, splits of the samples, powers of two, majorants, the form of a medium.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "reference/path_tracer/accumulation.h"
#include "reference/path_tracer/renderer.h"
#include "scene/base/error.h"
#include "scene/media/voxel_grid.h"
#include "tests/reference/path_tracer/scenes.h"
#include "tests/temporary_folder.h"

namespace invariance_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

constexpr int comparisons = 400;
const double limit = threshold(1e-3, comparisons);

void check_equal(const Estimate& a, const Estimate& b, double resolution = 0.02) {
  for (int c = 0; c < 3; ++c) {
    const double error = std::hypot(a.error[c], b.error[c]);
    CAPTURE(c, a.mean[c], b.mean[c], error);
    CHECK(std::abs(a.mean[c] - b.mean[c]) <= limit * error);
    CHECK(error < resolution * a.mean[c]);
  }
}

scene::Medium cloud(const Rgb& sigma_t, double scale = 1) {
  scene::GaussianSum sum;
  sum.gaussians = {{scale * Point3(0, 0, 0), scale * 0.5, 1},
                   {scale * Point3(0.5, 0.3, 0), scale * 0.3, 2},
                   {scale * Point3(-0.4, 0.2, 0.4), scale * 0.4, 0.7}};
  scene::Medium m;
  m.field = sum;
  m.region = scene::Sphere{{0, 0, 0}, scale};
  m.sigma_t = sigma_t / scale;
  m.albedo = {0.9, 0.8, 0.95};
  m.phase = scene::HenyeyGreenstein{0.4};
  return m;
}

scene::View small_view(double scale = 1) {
  scene::View view;
  view.camera = scene::look_at(scale * Point3(0.3, 0.5, 3), Point3::Zero(), Vec3::UnitY());
  view.camera.vertical_fov = 0.6;
  view.width = 19;
  view.height = 13;
  return view;
}

std::shared_ptr<scene::Scene> lit_cloud(double scale = 1) {
  return scene_of({cloud({3, 3, 3}, scale)},
                  {scene::PointLight{scale * Point3(0.6, 0.4, 0.5), Rgb(1, 2, 3) * scale * scale, 0},
                   scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb(1, 0.5, 0.2)}, white()});
}

Options some_options() {
  Options options;
  options.samples = 128;
  return options;
}

Accumulation rendered(const World& world, const scene::View& view, std::uint64_t begin, std::uint64_t end,
                      int threads) {
  Accumulation a = empty_accumulation(world, view);
  scene::Execution execution;
  execution.threads = threads;
  CHECK(render_range(world, view, begin, end, execution, a));
  return a;
}

bool same_layers(const scene::Film& a, const scene::Film& b) { return a.layers == b.layers; }

std::string scratch(const std::string& name) {
  static const TemporaryFolder folder;
  return folder.file(name);
}

}  // namespace

TEST_CASE("the same bits for any number of threads, and other ones for another seed", "[path_tracer]") {
  const World world(lit_cloud(), some_options());
  const scene::View view = small_view();
  const scene::Film one = to_film(world, view, rendered(world, view, 0, 192, 1));
  const scene::Film two = to_film(world, view, rendered(world, view, 0, 192, 2));
  CHECK(same_layers(one, two));
  Options other = some_options();
  other.seed = 2;
  const World reseeded(lit_cloud(), other);
  CHECK(to_film(reseeded, view, rendered(reseeded, view, 0, 192, 2)).layer("mean") != one.layer("mean"));
  other = some_options();
  other.stream = 1;
  const World restreamed(lit_cloud(), other);
  CHECK(to_film(restreamed, view, rendered(restreamed, view, 0, 192, 2)).layer("mean") != one.layer("mean"));
}

TEST_CASE("range files merged in any order give the bits of one render", "[path_tracer]") {
  const World world(lit_cloud(), some_options());
  const scene::View view = small_view();
  const std::uint64_t cuts[] = {0, 64, 256, 320, 400};
  const scene::Film whole = to_film(world, view, rendered(world, view, 0, 400, 2));
  std::vector<std::string> files;
  for (int i = 0; i < 4; ++i) {
    files.push_back(scratch(fmt::format("range{}", i)));
    write_range_file(files.back(), rendered(world, view, cuts[i], cuts[i + 1], 1 + i % 2));
  }
  std::vector<int> order = {0, 1, 2, 3};
  do {
    std::vector<std::string> shuffled;
    for (const int i : order) shuffled.push_back(files[i]);
    CHECK(same_layers(to_film(world, view, merge_range_files(shuffled)), whole));
  } while (std::next_permutation(order.begin(), order.end()));

  SECTION("overlaps and gaps are refused") {
    write_range_file(scratch("overlap"), rendered(world, view, 192, 320, 2));
    CHECK_THROWS_WITH(merge_range_files({files[0], files[1], scratch("overlap")}), Catch::Contains("overlap"));
    CHECK_THROWS_WITH(merge_range_files({files[0], files[2]}), Catch::Contains("samples 64..256 are missing"));
  }
  SECTION("another scene, seed, setting or view is refused") {
    const auto refused = [&](const World& other, const scene::View& v, const char* what) {
      write_range_file(scratch("other"), rendered(other, v, 64, 128, 2));
      CHECK_THROWS_WITH(merge_range_files({files[0], scratch("other")}), Catch::Contains(what));
    };
    auto scene = lit_cloud();
    scene->hash = "another";
    refused(World(scene, some_options()), view, "scene differs");
    Options options = some_options();
    options.seed = 9;
    refused(World(lit_cloud(), options), view, "seed differs: 1 and 9");
    options = some_options();
    options.box_pixels = true;
    refused(World(lit_cloud(), options), view, "settings differs");
    scene::View wider = view;
    wider.camera.vertical_fov = 0.7;
    refused(world, wider, "view");
  }
  SECTION("damaged files are refused, wherever the damage is") {
    std::ifstream in(files[0], std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    const auto refused = [&](const std::string& damaged, const char* what) {
      std::ofstream(scratch("damaged"), std::ios::binary) << damaged;
      CHECK_THROWS_WITH(read_range_file(scratch("damaged")), Catch::Contains(what));
    };
    refused("", "found an empty file");
    refused("something else altogether, and long enough to hold a header", "not a file of path tracer samples");
    for (const double share : {0.1, 0.5, 0.9, 0.9999})
      refused(bytes.substr(0, std::size_t(share * bytes.size())), "damaged");
    for (const double share : {0.01, 0.3, 0.99999}) {
      std::string flipped = bytes;
      flipped[std::size_t(share * bytes.size())] ^= 1;
      refused(flipped, "damaged");
    }
    CHECK_THROWS_WITH(read_range_file(scratch("nothing here")), Catch::Contains("no such file"));
  }
}

TEST_CASE("paths in a scene scaled by a power of two give the same bits", "[path_tracer]") {
  // Lengths times 2^k, extinction and intensity of point lights to match: radiances stay as they are.
  const World one(lit_cloud(1), some_options());
  const scene::Film expected = to_film(one, small_view(1), rendered(one, small_view(1), 0, 64, 2));
  for (const double scale : {0x1p-13, 0x1p10}) {
    const World scaled(lit_cloud(scale), some_options());
    const scene::Film film = to_film(scaled, small_view(scale), rendered(scaled, small_view(scale), 0, 64, 2));
    CHECK(same_layers(film, expected));
  }
}

TEST_CASE("the result does not depend on the majorants", "[path_tracer]") {
  const Ray ray = ray_of({0.2, 0.1, 3}, {0, 0, -1});
  std::vector<RadianceEstimate> results;
  const auto run = [&](auto change) {
    Options options = some_options();
    change(options);
    const World world(scene_of({cloud({3, 3, 3})}, {scene::DirectionalLight{}, white()}), options);
    results.push_back(radiance(world, ray, 1 << 16, {}, int(results.size())));
  };
  run([](Options&) {});
  run([](Options& o) { o.majorant_scale = 2; });
  run([](Options& o) { o.majorant_scale = 8; });
  run([](Options& o) { o.supergrid = false; });
  run([](Options& o) { o.supergrid_cells = 3; });
  run([](Options& o) { o.column_transmittance = false; });
  for (std::size_t i = 1; i < results.size(); ++i) {
    check_equal(results[0].total, results[i].total);
    check_equal(results[0].orders[1], results[i].orders[1]);
    CHECK(results[i].counters.violations == 0);
  }
  // The work does.
  CHECK(results[2].counters.lookups > 3 * results[0].counters.lookups);
}

TEST_CASE("forced first collisions change the noise and nothing else", "[path_tracer][thorough]") {
  const Ray ray = ray_of({0.2, 0.1, 3}, {0.02, 0, -1});
  const Box unit{{-1, -1, -1}, {1, 1, 1}};
  const scene::Light inside = scene::PointLight{{0.3, 0.5, -0.2}};
  int index = 100;
  double share_of_error = 0;
  for (const Rgb& sigma : {Rgb(0.02, 0.02, 0.02), Rgb(1, 1, 1), Rgb(0.1, 0.7, 3), Rgb(0.01, 0.2, 4)})
    for (const bool varies : {false, true})
      for (const auto& lights : {std::vector<scene::Light>{white()}, {white(), inside}, {inside}}) {
        scene::Medium m = varies ? cloud(sigma) : medium(unit, 1, 0.9);
        m.sigma_t = sigma;
        m.albedo = Rgb(0.9, 0.8, 0.5);
        RadianceEstimate results[2];
        for (const bool forced : {false, true}) {
          Options options = some_options();
          options.forced = forced;
          results[forced] = radiance(World(scene_of({m}, lights), options), ray, 1 << 15, {}, ++index);
        }
        CAPTURE(sigma, varies, lights.size());
        check_equal(results[0].total, results[1].total, 0.1);
        check_equal(results[0].orders[1], results[1].orders[1], 0.2);
        check_equal(results[0].orders[2], results[1].orders[2], 0.5);
        if (lights.size() == 1 && scene::light_name(lights[0]) == "environment" && sigma[0] == 0.02)
          share_of_error = std::max(share_of_error, results[1].total.error[0] / results[0].total.error[0]);
      }
  CHECK(share_of_error < 0.5);  // thin media: eight tries, so about an eighth of the variance; a quarter is asked
}

// Stress case 31.
TEST_CASE("a majorant below the truth voids the render", "[path_tracer]") {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {4, 4, 4};
  grid->voxel_size = 0.5;
  grid->translation = Vec3::Constant(-0.75);
  grid->values.assign(64, 1.0f);
  scene::Medium m = cloud({3, 3, 3});
  m.field = std::shared_ptr<const scene::VoxelGrid>(grid);
  m.region = scene::Unbounded{};
  Options options = some_options();
  options.majorant_scale = 0.9;
  const World world(scene_of({m}, {white()}), options);
  CHECK_THROWS_WITH(radiance(world, ray_of({0, 0, 3}, {0, 0, -1}), 256), Catch::Contains("exceeded its majorant"));
  Accumulation a = empty_accumulation(world, small_view());
  CHECK_THROWS_WITH(render_range(world, small_view(), 0, 64, {}, a), Catch::Contains("void"));
}

TEST_CASE("a constant grid is a homogeneous box", "[path_tracer]") {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {6, 4, 5};
  grid->voxel_size = 0.25;
  grid->clamp_border = true;
  grid->translation = {-0.6, -0.3, -0.5};
  grid->values.assign(6 * 4 * 5, 0.5f);
  scene::Medium voxels = cloud({8, 8, 8}), box = voxels;
  voxels.field = std::shared_ptr<const scene::VoxelGrid>(grid);
  voxels.region = scene::Unbounded{};
  box.field = scene::Homogeneous{0.5};
  box.region = Box{Point3(-0.6, -0.3, -0.5) - Vec3::Constant(0.125),
                   Point3(-0.6, -0.3, -0.5) + Vec3(6 * 0.25, 4 * 0.25, 5 * 0.25) - Vec3::Constant(0.125)};
  const std::vector<scene::Light> lights = {white(), scene::PointLight{{0.1, 0.2, 0.1}, Rgb(1, 2, 3), 0}};
  const World a(scene_of({voxels}, lights), some_options()), b(scene_of({box}, lights), some_options());
  const Ray ray = ray_of({0.15, 0.05, 3}, {0.02, 0, -1});
  const auto first = radiance(a, ray, 1 << 17, {}, 1), second = radiance(b, ray, 1 << 17, {}, 2);
  check_equal(first.total, second.total, 0.03);
  for (int m = 1; m <= 4; ++m) check_equal(first.orders[m], second.orders[m], 0.03);
}

// Stress case 21: two media in one place are one with the sum of the coefficients.
TEST_CASE("overlapping media add", "[path_tracer]") {
  const scene::Region ball = scene::Sphere{{0, 0, 0}, 1};
  const std::vector<scene::Light> lights = {white(), scene::PointLight{{0.4, 0.2, 0.1}, Rgb::Ones(), 0}};
  // 1.2 of albedo 0.9 and 0.8 of albedo 0.6 make 2 of albedo 0.78, with one phase function.
  const scene::PhaseFunction phase = scene::HenyeyGreenstein{0.3};
  const World two(scene_of({medium(ball, 1.2, 0.9, phase), medium(ball, 0.8, 0.6, phase)}, lights), some_options());
  const World one(scene_of({medium(ball, 2, 0.78, phase)}, lights), some_options());
  const Ray ray = ray_of({0.25, -0.3, 3}, {0, 0, -1});
  const auto first = radiance(two, ray, 1 << 16, {}, 1), second = radiance(one, ray, 1 << 16, {}, 2);
  check_equal(first.total, second.total);
  for (int m = 1; m <= 4; ++m) check_equal(first.orders[m], second.orders[m]);
}

// Spectral weights: each channel alone is a grey scene.
TEST_CASE("coloured extinction agrees with its channels one by one", "[path_tracer]") {
  const Rgb sigma(0.7, 2, 6);
  const std::vector<scene::Light> lights = {white(), scene::PointLight{{0.4, 0.2, 0.1}, Rgb::Ones(), 0},
                                            scene::DirectionalLight{}};
  const Ray ray = ray_of({0.2, 0.1, 3}, {0, 0, -1});
  const World coloured(scene_of({cloud(sigma), medium(Box{{-1, -1, -1}, {0, 1, 1}}, 0.5, 0.5)}, lights),
                       some_options());
  CHECK_FALSE(coloured.media().grey());
  const auto together = radiance(coloured, ray, 1 << 17, {}, 1);
  for (int c = 0; c < 3; ++c) {
    const World grey(scene_of({cloud(Rgb::Constant(sigma[c])), medium(Box{{-1, -1, -1}, {0, 1, 1}}, 0.5, 0.5)}, lights),
                     some_options());
    CHECK(grey.media().grey());
    const auto alone = radiance(grey, ray, 1 << 16, {}, 2 + c);
    for (int m = 0; m <= 3; ++m) {
      const double error = std::hypot(together.orders[m].error[c], alone.orders[m].error[c]);
      CAPTURE(c, m, together.orders[m].mean[c], alone.orders[m].mean[c], error);
      CHECK(std::abs(together.orders[m].mean[c] - alone.orders[m].mean[c]) <= limit * error + 1e-12);
    }
  }
}

TEST_CASE("layers of a film fit together", "[path_tracer]") {
  Options options = some_options();
  options.samples = 1024;
  const World world(lit_cloud(), options);
  const scene::View view = small_view();
  const scene::Film film = to_film(world, view, rendered(world, view, 0, 1024, 2));
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      Rgb orders = film.get("order.rest", x, y), batches = Rgb::Zero();
      for (int m = 0; m <= 4; ++m) orders += film.get(fmt::format("order.{}", m), x, y);
      for (int b = 0; b < 16; ++b) batches += film.get(fmt::format("batch.{:02}", b), x, y);
      const Rgb mean = film.get("mean", x, y);
      const Rgb halves = film.get("half.A", x, y) + film.get("half.B", x, y);
      for (int c = 0; c < 3; ++c) {
        // Seven, sixteen and two floats of relative error 6e-8.
        CHECK(orders[c] == Approx(mean[c]).epsilon(1e-6).margin(1e-9));
        CHECK(batches[c] / 16 == Approx(mean[c]).epsilon(1e-6).margin(1e-9));
        CHECK(halves[c] / 2 == Approx(mean[c]).epsilon(1e-6).margin(1e-9));
      }
      CHECK(film.get("n", x, y)[0] == 1024);
      // Order 0 is the white background through the medium, without noise.
      CHECK(film.get("order.0", x, y)[0] == Approx(film.get("transmittance", x, y)[0]).epsilon(1e-6));
    }
}

}  // namespace invariance_test
