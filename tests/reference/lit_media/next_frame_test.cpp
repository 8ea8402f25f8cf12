// Prepared::next of froxels, the half-resolution march and the ray marcher: frames have the bits of frames made anew, and maps of lights that
// still hold are kept.
#include <catch2/catch.hpp>

#include "experiments/application/renderers.h"
#include "tests/reference/lit_media/next_frames.h"

namespace lit_media_next_frame_test {

using namespace lit_media_next_frames;

TEST_CASE("lit media: the next frame is the frame made anew, and makes the maps that changed alone", "[lit_media]") {
  const auto still = std::make_shared<const Scene>(yard());
  for (const Case& c : cases) {
    const scene::Renderer& renderer = experiments::find_renderer(c.renderer, "next_frame_test");
    const scene::Settings settings{renderer.settings(), c.given};
    const auto prepared = renderer.prepare(still, settings, {1, {}});
    const scene::Rendering first = prepared->render(view_of(*still), {1, {}});
    for (const Change& change : changes) {
      CAPTURE(c.renderer, c.given, change.name);
      const SharedScene there = changed(*still, change);
      const scene::Rendering next = test::next_frame(*prepared, there);
      CHECK(next.film.layers ==
            renderer.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}}).film.layers);
      CHECK(next.film.layers != first.film.layers);
      if (maps_made(first)) {
        CHECK(maps_made(first) == 2);
        CHECK(maps_made(next) == change.maps_made);
      }
      CHECK(test::next_frame(*prepared, still).film.layers == first.film.layers);  // and back
    }
  }
}

}  // namespace lit_media_next_frame_test
