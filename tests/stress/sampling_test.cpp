// Stress cases 29 to 32: sample numbers, ranges, majorants and uniforms at their ends.
#include "reference/path_tracer/sampling.h"

#include <algorithm>
#include <set>

#include "reference/path_tracer/accumulation.h"
#include "reference/path_tracer/surface_sampling.h"
#include "scene/math/elementary.h"
#include "scene/media/voxel_grid.h"
#include "tests/stress/stress.h"
#include "tests/temporary_folder.h"

namespace sampling_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

std::shared_ptr<scene::Scene> cloud() {
  scene::GaussianSum sum;
  sum.gaussians = {{{0, 0, 0}, 0.5, 1}, {{0.5, 0.3, 0}, 0.3, 2}};
  return scene_of({of_field(sum, 3, 0.9)}, {white(), scene::PointLight{{0.6, 0.4, 0.5}}});
}

}  // namespace

TEST_CASE("stress 29: one sample, sample 2^40, pixel 2^32 - 1", "[stress]") {
  // All blocks of random numbers of neighbours, of the far ends and of the dimensions are different.
  const std::uint64_t samples[] = {0,
                                   1,
                                   63,
                                   64,
                                   (std::uint64_t(1) << 32) - 1,
                                   std::uint64_t(1) << 32,
                                   std::uint64_t(1) << 40,
                                   (std::uint64_t(1) << 40) + 1,
                                   ~std::uint64_t(0)};
  const std::uint32_t pixels[] = {0, 1, 1u << 31, ~0u - 1, ~0u}, vertices[] = {0, 1, 15, 16, 17, (1u << 28) - 1};
  std::set<PhiloxCounter> seen;
  std::size_t asked = 0;
  for (const std::uint64_t sample : samples)
    for (const std::uint32_t pixel : pixels)
      for (const std::uint32_t vertex : vertices)
        for (std::uint32_t purpose = 0; purpose < 6; ++purpose)
          for (const std::uint32_t index : {0u, 1u, (1u << 24) - 1}) {
            seen.insert(SampleRandom(1, 0, pixel, sample).block(vertex, Purpose(purpose), index).words);
            ++asked;
          }
  CHECK(seen.size() == asked);  // by chance two of 5e3 would be alike once in 1e31 runs

  const auto scene = cloud();
  const auto view = view_from({0.3, 0.5, 3}, {0, 0, 0}, 3);
  const scene::Film one = picture("path_tracer", scene, view, {{"samples", "1"}});
  CHECK(all_finite(one));
  CHECK(one.get("n", 1, 1)[0] == 1);
  const World world(scene, Options{});
  const auto range = [&](std::uint64_t begin) {
    path_tracer::Accumulation a = path_tracer::empty_accumulation(world, view);
    CHECK(path_tracer::render_range(world, view, begin, begin + 64, {}, a));
    return a;
  };
  const std::uint64_t far = std::uint64_t(1) << 40;
  const auto late = range(far), early = range(0), wrapped = range(std::uint64_t(1) << 32);
  CHECK(late.tiles[0].front().begin() == far);
  CHECK(late.tiles[0].front().sums != early.tiles[0].front().sums);
  CHECK(wrapped.tiles[0].front().sums != early.tiles[0].front().sums);
  CHECK(all_finite(path_tracer::to_film(world, view, late)));
  const Ray ray = ray_of({0.1, 0.2, 3}, {0, 0, -1});
  const auto last = radiance(world, ray, 1 << 13, {}, ~0u), first = radiance(world, ray, 1 << 13, {}, 0);
  CHECK(last.total.mean[0] != first.total.mean[0]);
  check_equal(first.total.mean[0], last.total.mean[0], std::hypot(first.total.error[0], last.total.error[0]), 0.05);
}

TEST_CASE("stress 30: ranges merged in all orders, overlapping, with a gap", "[stress]") {
  const TemporaryFolder folder;
  const World world(cloud(), Options{});
  const auto view = view_from({0.3, 0.5, 3}, {0, 0, 0}, 11);
  const auto rendered = [&](std::uint64_t begin, std::uint64_t end, int threads) {
    path_tracer::Accumulation a = path_tracer::empty_accumulation(world, view);
    scene::Execution execution;
    execution.threads = threads;
    CHECK(path_tracer::render_range(world, view, begin, end, execution, a));
    return a;
  };
  const scene::Film whole = path_tracer::to_film(world, view, rendered(0, 300, 2));
  std::vector<std::string> files;
  const std::uint64_t cuts[] = {0, 64, 192, 300};
  for (int i = 0; i < 3; ++i) {
    files.push_back(folder.file("range" + std::to_string(i)));
    path_tracer::write_range_file(files[i], rendered(cuts[i], cuts[i + 1], 1 + i % 2));
  }
  const auto sorted = files;
  do {
    CHECK(path_tracer::to_film(world, view, path_tracer::merge_range_files(files)).layers == whole.layers);
  } while (std::next_permutation(files.begin(), files.end()));
  path_tracer::write_range_file(folder.file("overlap"), rendered(128, 192, 2));
  CHECK_THROWS_WITH(path_tracer::merge_range_files({sorted[0], sorted[1], folder.file("overlap")}),
                    Catch::Contains("overlap"));
  CHECK_THROWS_WITH(path_tracer::merge_range_files({sorted[0], sorted[2]}), Catch::Contains("64..192 are missing"));
}

TEST_CASE("stress 31: majorants of 0.9 of the truth void the render", "[stress]") {
  scene::VoxelGrid grid;
  grid.size = {4, 4, 4};
  grid.voxel_size = 0.5;
  grid.translation = Vec3::Constant(-0.75);
  grid.values.assign(64, 1.0f);
  const auto view = view_from({0, 0, 3}, {0, 0, 0});
  for (const scene::Medium& m : {of_grid(grid, 3, 0.9), cloud()->media[0]}) {
    const auto scene = scene_of({m}, {white()});
    CHECK_THROWS_WITH(picture("path_tracer", scene, view, {{"majorant_scale", "0.5"}}),
                      Catch::Contains("exceeded its majorant") && Catch::Contains("void"));
    CHECK_NOTHROW(picture("path_tracer", scene, view, {{"majorant_scale", "1"}, {"samples", "64"}}));
  }
  CHECK_THROWS_WITH(
      picture("path_tracer", scene_of({of_grid(grid, 3, 0.9)}, {white()}), view, {{"majorant_scale", "0.9"}}),
      Catch::Contains("void"));
}

TEST_CASE("stress 32: uniforms 0 and 1 - ulp at every sampler", "[stress]") {
  // Numbers of the generator lie strictly between.
  CHECK(uniform53(0, 0) > 0);
  CHECK(uniform53(~0u, ~0u) < 1);
  CHECK(uniform32(0) > 0);
  CHECK(uniform32(~0u) < 1);
  CHECK((elementary::log(uniform53(0, 0)) > -37 && elementary::log(uniform53(~0u, ~0u)) < 0));
  const double ends[] = {0,   std::nextafter(0.0, 1.0), uniform53(0, 0),     uniform32(0),
                         0.5, uniform32(~0u),           uniform53(~0u, ~0u), std::nextafter(1.0, 0.0)};
  const auto map = std::make_shared<scene::EnvironmentMap>(scene::EnvironmentMap{4, 2, std::vector<float>(24, 0.5f)});
  const auto mapped = scene::make_map_environment(map, Mat3::Identity(), Rgb::Ones(), "test");
  const auto harmonic =
      scene::make_sh_environment({Rgb::Ones(), Rgb::Zero(), Rgb::Ones(), Rgb::Zero()}, Mat3::Identity(), Rgb::Ones());
  const Vec3 normal = Vec3::UnitY(), in = Vec3(1, 1, 0).normalized();
  for (const double u : ends)
    for (const double v : ends) {
      CAPTURE(u, v);
      for (const double g : {0.0, 1e-12, 0.5, 0.999, -0.999})
        for (const char* const name : {"isotropic", "rayleigh", "hg", "hazy", "murky"}) {
          const double c = scene::sample_phase_cosine(path_tracer::test::phase_of(name, g), u);
          CHECK((c >= -1 && c <= 1));
          CHECK(path_tracer::turned(Vec3(0.6, 0, 0.8), c, v).norm() == Approx(1).epsilon(1e-12));
        }
      for (const auto& light : {white(), mapped, harmonic}) {
        const Vec3 w = scene::sample_environment(light, u, v);
        CHECK(w.norm() == Approx(1).epsilon(1e-12));
        CHECK((scene::pdf_environment(light, w) > 0 && std::isfinite(scene::pdf_environment(light, w))));
      }
      for (const double end : {2.0, infinity})
        for (const double h : {1e-12, 1.0, 1e12}) {
          const path_tracer::Equiangular angles({{0, 0, 0}, {0, 0, 1}}, {h, 0, 1}, {0, end});
          const double t = angles.sample(u);
          CHECK((t >= 0 && t <= end && std::isfinite(t)));
          CHECK((angles.pdf(t) >= 0 && std::isfinite(angles.pdf(t))));
        }
      for (const scene::Material& material :
           {scene::Material(scene::Lambert{}), scene::Material(scene::Phong{Rgb::Zero(), Rgb::Ones(), 1e5})}) {
        const Vec3 out = path_tracer::sample_reflection(material, normal, in, v, u, v);
        CHECK(out.norm() == Approx(1).epsilon(1e-12));
        CHECK(std::isfinite(path_tracer::pdf_reflection(material, normal, in, out)));
      }
    }
}

}  // namespace sampling_test
