#include "reference/path_tracer/cache.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "reference/path_tracer/stopping.h"
#include "scene/base/error.h"
#include "tests/reference/path_tracer/scenes.h"
#include "tests/temporary_folder.h"

namespace cache_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

std::shared_ptr<scene::Scene> ball() { return scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 2, 0.9)}, {white()}); }

scene::View view_of_ball() {
  scene::View view;
  view.camera = scene::look_at({0, 0, 4}, {0, 0, 0}, Vec3::UnitY());
  view.width = 20;
  view.height = 10;
  return view;
}

World world_of(std::uint64_t samples) {
  Options options;
  options.samples = samples;
  return World(ball(), options);
}

// A name for a folder that does not exist yet.
std::string folder(const std::string& name) {
  static const TemporaryFolder parent;
  return parent.file(name);
}

scene::Film direct(std::uint64_t samples) {
  const World world = world_of(samples);
  Accumulation a = empty_accumulation(world, view_of_ball());
  render_range(world, view_of_ball(), 0, samples, {}, a);
  return to_film(world, view_of_ball(), a);
}

}  // namespace

TEST_CASE("a cached picture is reused and refined to the same bits", "[path_tracer]") {
  const std::string cache = folder("refine");
  const auto first = render_cached(world_of(100), view_of_ball(), cache, {});
  CHECK(first.found == 0);
  CHECK(first.film.layers == direct(100).layers);
  const auto again = render_cached(world_of(100), view_of_ball(), cache, {});
  CHECK(again.found == 100);
  CHECK(again.counters.paths == first.counters.paths);
  CHECK(again.film.layers == first.film.layers);
  // The 36 samples beyond the first block cannot be told from the rest of theirs: counters would count them twice.
  const auto anew = render_cached(world_of(512), view_of_ball(), cache, {});
  CHECK(anew.found == 0);
  CHECK(anew.film.layers == direct(512).layers);
  const auto refined = render_cached(world_of(1024), view_of_ball(), cache, {});
  CHECK(refined.found == 512);
  CHECK(refined.film.layers == direct(1024).layers);
}

// Up and down: whatever the folder holds, a picture has the samples that were asked for, and their bits and counters.
TEST_CASE("a cached picture does not depend on what else the cache holds", "[path_tracer]") {
  const std::string cache = folder("exact");
  for (const std::uint64_t samples : {256, 64, 192, 256, 65, 1000, 128, 64, 512, 1000}) {
    CAPTURE(samples);
    const auto kept = render_cached(world_of(samples), view_of_ball(), cache, {});
    const auto fresh = render_cached(world_of(samples), view_of_ball(), folder(std::to_string(samples)), {});
    CHECK(kept.notes.empty());
    CHECK(kept.film.layers == fresh.film.layers);
    CHECK(kept.film.layers == direct(samples).layers);
    CHECK(kept.film.metadata.at("samples") == std::to_string(samples));
    CHECK(kept.counters.named() == fresh.counters.named());
  }
}

// Whether a tile goes on is decided by its error: samples that another picture left must not change that.
TEST_CASE("a cached picture with a target error is that of a render in one go", "[path_tracer]") {
  Options options;
  options.samples = 4096;
  options.target_error = 0.001;
  const World world(ball(), options);
  Accumulation a = empty_accumulation(world, view_of_ball());
  render_to_target(world, view_of_ball(), {}, a);
  const auto in_one_go = to_film(world, view_of_ball(), a).layers;
  const std::string cache = folder("target");
  render_cached(world_of(1024), view_of_ball(), cache, {});
  CHECK(render_cached(world, view_of_ball(), cache, {}, 0.0).film.layers == in_one_go);
  const auto again = render_cached(world, view_of_ball(), cache, {});
  CHECK(again.found == 64);  // of the corners
  CHECK(again.film.layers == in_one_go);
  CHECK(render_cached(world_of(1024), view_of_ball(), cache, {}).film.layers == direct(1024).layers);
}

TEST_CASE("what an interrupted render has done is kept and completed", "[path_tracer]") {
  const std::string cache = folder("interrupt");
  int calls = 0;
  scene::Execution stopping;
  stopping.threads = 1;
  stopping.progress = [&](double) { return ++calls < 9; };
  const auto part = render_cached(world_of(512), view_of_ball(), cache, stopping);
  CHECK_FALSE(part.complete);
  CHECK(part.film.metadata.at("complete") == "false");
  CHECK(part.counters.paths > 0);
  CHECK(part.counters.paths < 512u * 200u);
  const auto whole = render_cached(world_of(512), view_of_ball(), cache, {});
  CHECK(whole.complete);
  CHECK(whole.counters.paths == 512u * 200u);
  CHECK(whole.film.layers == direct(512).layers);
}

// As the tasks of a cluster do it: ranges in any order, one of them interrupted, one never computed.
TEST_CASE("ranges kept by several tasks join to the bits of one render", "[path_tracer]") {
  const std::string cache = folder("ranges");
  const World world = world_of(1000);
  CHECK(keep_range(world, view_of_ball(), cache, 512, 1000, {}));
  int calls = 0;
  scene::Execution stopping;
  stopping.threads = 1;
  stopping.progress = [&](double) { return ++calls < 3; };
  CHECK_FALSE(keep_range(world, view_of_ball(), cache, 0, 256, stopping));
  const std::string interrupted = range_file(cache, empty_accumulation(world, view_of_ball()).identity, 0, 256);
  const auto paths = [&] { return read_range_file(interrupted).counters.paths; };
  const auto before = paths();
  CHECK(before < 256u * 200u);
  CHECK(keep_range(world, view_of_ball(), cache, 0, 256, {}));
  CHECK(paths() == 256u * 200u);
  const auto whole = render_cached(world, view_of_ball(), cache, {});
  CHECK(whole.notes.empty());
  CHECK(whole.film.layers == direct(1000).layers);
  CHECK(whole.counters.paths == 1000u * 200u);
  CHECK_FALSE(std::filesystem::exists(interrupted));  // the picture's own file has its samples
  CHECK(render_cached(world, view_of_ball(), cache, {}).found == 1000);
  for (const auto& [begin, end] : {std::pair{64, 64}, {0, 1001}, {32, 64}, {0, 100}})
    CHECK_THROWS_AS(keep_range(world, view_of_ball(), cache, begin, end, {}), Error);
  Options adaptive;
  adaptive.target_error = 0.01;
  CHECK_THROWS_AS(keep_range(World(ball(), adaptive), view_of_ball(), cache, 0, 64, {}), Error);
}

TEST_CASE("a damaged range is computed again, and other samples do not disturb ranges", "[path_tracer]") {
  const std::string cache = folder("damaged_range");
  const World world = world_of(512);
  keep_range(world, view_of_ball(), cache, 256, 512, {});
  keep_range(world, view_of_ball(), cache, 64, 256, {});
  render_cached(world_of(128), view_of_ball(), cache, {});  // 64..128 twice: the range is left alone
  const std::string damaged = range_file(cache, empty_accumulation(world, view_of_ball()).identity, 256, 512);
  std::filesystem::resize_file(damaged, std::filesystem::file_size(damaged) / 2);
  const auto whole = render_cached(world, view_of_ball(), cache, {});
  CHECK(whole.found == 128);
  REQUIRE(whole.notes.size() == 1);
  CHECK(whole.film.layers == direct(512).layers);
  CHECK(whole.counters.paths == 512u * 200u);
}

TEST_CASE("frequent saving does not change the bits", "[path_tracer]") {
  const auto saved = render_cached(world_of(256), view_of_ball(), folder("often"), {}, 0.0);
  CHECK(saved.complete);
  CHECK(saved.film.layers == direct(256).layers);
}

TEST_CASE("a damaged cache file is reported, set aside and not used", "[path_tracer]") {
  const std::string cache = folder("damage");
  const World world = world_of(64);
  render_cached(world, view_of_ball(), cache, {});
  const std::string file = cache_file(cache, empty_accumulation(world, view_of_ball()).identity, world.options());
  REQUIRE(std::filesystem::exists(file));
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const auto result = render_cached(world, view_of_ball(), cache, {});
  CHECK(result.found == 0);
  REQUIRE(result.notes.size() == 1);
  CHECK_THAT(result.notes[0], Catch::Contains("damaged"));
  CHECK(std::filesystem::exists(file + ".damaged"));
  CHECK(result.film.layers == direct(64).layers);
  CHECK(render_cached(world, view_of_ball(), cache, {}).found == 64);
}

TEST_CASE("a cache folder that cannot be made is an error with its name", "[path_tracer]") {
  CHECK_THROWS_WITH(render_cached(world_of(64), view_of_ball(), "/dev/null/cache", {}),
                    Catch::Contains("/dev/null/cache"));
}

TEST_CASE("a target error stops tiles one by one", "[path_tracer]") {
  Options options;
  options.samples = 4096;
  options.target_error = 0.001;
  const World world(ball(), options);
  Accumulation a = empty_accumulation(world, view_of_ball());
  render_to_target(world, view_of_ball(), {}, a);
  const scene::Film film = to_film(world, view_of_ball(), a);
  std::set<double> counts;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) counts.insert(film.get("n", x, y)[0]);
  CHECK(counts.size() > 1);  // the corners see nothing but the sky, the middle needs more
  for (const double n : counts) CHECK(std::exp2(std::round(std::log2(n))) == n);
  CHECK(*counts.begin() == 64);
}

}  // namespace cache_test
