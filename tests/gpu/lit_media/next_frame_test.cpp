// Prepared::next of froxels, the half-resolution march and the ray marcher on the device: frames have the bits of frames made anew, what still
// holds stays on the device, and what changed goes into the buffers that are there.
#include "experiments/application/renderers.h"
#include "tests/gpu/device.h"
#include "tests/reference/lit_media/next_frames.h"

namespace lit_media_gpu_next_frame_test {

using namespace lit_media_next_frames;

namespace {

const scene::Renderer& on_device(const Case& c) {
  return experiments::find_renderer(std::string(c.renderer) + "_gpu", "next_frame_test");
}

}  // namespace

DEVICE_TEST_CASE("lit media on the device: the next frame is the frame made anew", "[gpu][lit_media]") {
  const auto still = std::make_shared<const Scene>(yard());
  for (const Case& c : cases) {
    const scene::Renderer& renderer = on_device(c);
    const scene::Settings settings{renderer.settings(), c.given};
    const auto prepared = renderer.prepare(still, settings, {1, {}});
    const scene::Rendering first = prepared->render(view_of(*still), {1, {}});
    CHECK(first.counters.count("next_bytes_up") == 0);
    for (const Change& change : changes) {
      CAPTURE(c.renderer, c.given, change.name);
      const SharedScene there = changed(*still, change);
      const scene::Rendering next = test::next_frame(*prepared, there);
      CHECK(next.film.layers ==
            renderer.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}}).film.layers);
      CHECK(next.film.layers != first.film.layers);
      CHECK(test::next_frame(*prepared, still).film.layers == first.film.layers);  // and back
    }
  }
}

// Where programs and buffers serve the next frame, nothing is allocated or looked up; where media are the same, only lights go up.
DEVICE_TEST_CASE("lit media on the device: a next frame uploads what changed, into what is there", "[gpu][lit_media]") {
  const std::set<std::string> lights{"camera", "a moved lamp", "a dimmed lamp", "a turned sun"},
      media{"moved smoke", "other smoke", "moved patches", "denser patches"};
  const auto still = std::make_shared<const Scene>(yard());
  for (const Case& c : cases) {
    const scene::Renderer& renderer = on_device(c);
    const auto prepared = renderer.prepare(still, {renderer.settings(), c.given}, {1, {}});
    for (const Change& change : changes) {
      if (!lights.count(change.name) && !media.count(change.name)) continue;
      CAPTURE(c.renderer, c.given, change.name);
      const SharedScene there = changed(*still, change);
      for (const SharedScene& at : {there, still}) test::next_frame(*prepared, at);
      const scene::Rendering next = test::next_frame(*prepared, there);
      for (const char* counter : {"next_allocations", "allocations", "bytes_up"}) {
        CAPTURE(counter);
        CHECK(next.counters.at(counter) == 0);
      }
      if (maps_made(next)) CHECK(maps_made(next) == change.maps_made);
      // Two lights of 48 bytes, the rules of their maps, the parts of media that a map is drawn with.
      const double of_lights = 2 * 48 + 2 * 17 * 4 + 2 * 48, of_grid = 4 * 10 * 9 * 8;
      if (lights.count(change.name)) CHECK(next.counters.at("next_bytes_up") <= of_lights);
      if (change.name == std::string("camera")) CHECK(next.counters.at("next_bytes_up") == 0);
      if (media.count(change.name))
        CHECK((next.counters.at("next_bytes_up") >= of_grid) == (change.name == std::string("other smoke")));
      test::next_frame(*prepared, still);
    }
  }
}

}  // namespace lit_media_gpu_next_frame_test
