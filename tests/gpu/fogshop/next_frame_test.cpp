// Prepared::next on the device: frames whose lights or media have moved have the bits of a preparation of their own, and only what changed is
// uploaded and made again.
#include "gpu/fogshop/fogshop.h"
#include "tests/gpu/device.h"
#include "tests/methods/fogshop/next_frames.h"

namespace fogshop_gpu_next_frame_test {

using namespace airlight;
using namespace fogshop_next_frames;

namespace {
const gpu::fogshop::Fogshop method;
}

DEVICE_TEST_CASE("fogshop on the device: the next frame is the frame made anew", "[gpu][fogshop]") {
  const Pairs kinds[] = {
      everything, {{"variant", "paper"}, {"reflectance", "sun"}}, {{"downsample", "2"}, {"noise_scale", "0.3"}}};
  const auto still = std::make_shared<const Scene>(garden());
  for (const Pairs& given : kinds) {
    const scene::Settings settings(method.settings(), given);
    const auto prepared = method.prepare(still, settings, {1, {}});
    const scene::Film first = prepared->render(view_of(*still), {1, {}}).film;
    for (const Change& change : changes) {
      CAPTURE(given, change.name);
      const auto there = changed(*still, change);
      REQUIRE(prepared->next(there, {1, {}}));
      const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
      CHECK(next.film.layers == method.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}}).film.layers);
      if (!change.same_picture) CHECK(next.film.layers != first.layers);
      REQUIRE(prepared->next(still, {1, {}}));  // and back
      CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.layers);
    }
  }
}

// Bytes that go up are those of what changed, and buffers that are there are used again.
DEVICE_TEST_CASE("fogshop on the device: a next frame uploads what changed, into what is there", "[gpu][fogshop]") {
  const auto still = std::make_shared<const Scene>(garden());
  // Without a tree of average depths, which is another tree where Gaussians move.
  const auto prepared = method.prepare(still, {method.settings(), {{"average_depth", "exact"}}}, {1, {}});
  CHECK(prepared->render(view_of(*still), {1, {}}).counters.count("next_bytes_up") == 0);
  const double gaussians = 32 * 30, lights = 16 * 80;
  // Lights on surfaces send places, and where the lists by directions begin (32^2 directions of two lights).
  const double places = 2 * 24, lists = 4 * (2 * 32 * 32 + 1);
  struct Cost {
    std::string name;
    double bytes, maps;
  };
  const Cost costs[] = {{"camera", 0, 0},
                        {"one lamp moved", lights + places + lists, 1},
                        {"a dimmed lamp", lights, 0},
                        {"moved Gaussians", gaussians + lights + lists, 2}};
  for (const Cost& cost : costs) {
    CAPTURE(cost.name);
    const auto change =
        std::find_if(std::begin(changes), std::end(changes), [&](const Change& c) { return c.name == cost.name; });
    REQUIRE(change != std::end(changes));
    const auto there = changed(*still, *change);
    const auto frame = [&](const std::shared_ptr<const Scene>& at) {
      REQUIRE(prepared->next(at, {1, {}}));
      return prepared->render(view_of(*at), {1, {}}).counters;
    };
    frame(there), frame(still);
    const auto counters = frame(there);
    CHECK(counters.at("next_allocations") == 0);
    CHECK(counters.at("allocations") == 0);
    CHECK(counters.at("bytes_up") == 0);
    CHECK(counters.at("light_maps_made") == cost.maps);
    UNSCOPED_INFO("bytes " << counters.at("next_bytes_up"));
    CHECK(counters.at("next_bytes_up") == cost.bytes);
    CHECK((counters.at("next_bytes_up") > 0) == (cost.bytes > 0));
  }
}

}  // namespace fogshop_gpu_next_frame_test
