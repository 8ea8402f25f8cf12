// Prepared::next on the device: frames whose lights, media or surfaces have changed have the bits of a preparation of their own, and only
// what changed is uploaded.
#include "gpu/legendre_fluids/light.h"
#include "tests/gpu/device.h"
#include "tests/methods/legendre_fluids/next_frames.h"
#include "tests/refused_frame.h"

namespace legendre_gpu_next_frame_test {

using namespace airlight;
using namespace legendre_next_frames;

namespace {
const gpu::legendre_fluids::LegendreLight method;
}

DEVICE_TEST_CASE("legendre fluids on the device: the next frame is the frame made anew",
                 "[gpu][legendre_fluids][thorough]") {
  const auto still = std::make_shared<const Scene>(smoke_over_floor());
  const scene::Settings settings(method.settings(), given);
  const auto prepared = method.prepare(still, settings, {1, {}});
  const scene::Film first = prepared->render(view_of(*still), {1, {}}).film;
  for (const Change& change : changes) {
    CAPTURE(change.name);
    const auto there = changed(*still, change);
    const auto times = prepared->next(there, {1, {}});
    REQUIRE(times);
    if (change.keeps) CHECK(times->empty());
    const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
    CHECK(next.film.layers == method.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}}).film.layers);
    if (change.keeps)
      for (const char* counter :
           {"next_bytes_up", "next_bytes_down", "next_allocations", "next_syncs", "next_program_look_ups"})
        CHECK(next.counters.at(counter) == 0);
    CHECK((next.film.layers == first.layers) == change.same);
    REQUIRE(prepared->next(still, {1, {}}));  // and back
    CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.layers);
  }
}

// Coefficients of a frame go up into the buffer that is there, and nothing else does.
DEVICE_TEST_CASE("legendre fluids on the device: a next frame uploads coefficients alone", "[gpu][legendre_fluids]") {
  auto still =
      std::make_shared<Scene>(*lit_scene(smoke(random_density({4, 4, 4}, 3), 1), oblique_light, oblique_view, 8, 6));
  still->media.push_back(still->media[0]);
  become(still->media[1], 4);
  finish(*still);
  const auto prepared = method.prepare(still, {method.settings(), {}}, {1, {}});
  CHECK(prepared->render(view_of(*still), {1, {}}).counters.count("next_bytes_up") == 0);
  for (unsigned seed = 5; seed < 8; ++seed) {
    auto there = std::make_shared<Scene>(*still);
    become(there->media[1], seed);
    finish(*there);
    REQUIRE(prepared->next(there, {1, {}}));
    const auto counters = prepared->render(view_of(*there), {1, {}}).counters;
    CHECK(counters.at("next_bytes_up") == 2 * 64 * sizeof(float));  // of both media
    for (const char* counter : {"next_bytes_down", "next_program_look_ups", "bytes_up", "allocations"})
      CHECK(counters.at(counter) == 0);
    if (seed > 5) CHECK(counters.at("next_allocations") == 0);  // the first has queries for its time
  }
}

// Another number of lamps has systems of another layout, which are all solved.
DEVICE_TEST_CASE("legendre fluids on the device: the paper's systems of the next frame",
                 "[gpu][legendre_fluids][thorough]") {
  const auto still = std::make_shared<const Scene>(smoke_for_systems());
  for (const char* closure : {"least_squares", "upwind"}) {
    const scene::Settings settings(method.settings(), {{"variant", "paper"}, {"n", "4"}, {"closure", closure}});
    const auto prepared = method.prepare(still, settings, {1, {}});
    const scene::Film first = prepared->render(view_of(*still), {1, {}}).film;
    for (const PaperChange& change : paper_changes) {
      CAPTURE(closure, change.name);
      const auto there = changed(*still, change);
      const bool goes_on = prepared->next(there, {1, {}}).has_value();
      CHECK(goes_on == !there->media.empty());
      if (!goes_on) continue;  // variant `ray` draws what is left
      const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
      const scene::Film anew = method.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}}).film;
      CHECK(next.film.layers == anew.layers);
      CHECK((next.film.layers == first.layers) == change.same);
      const bool other_layout = there->lights.size() != still->lights.size();
      CHECK((next.counters.at("direct_systems_made") > 0) == (change.systems_made > 0 || other_layout));
      const std::string name = change.name;
      if (name == "nothing" || name == "camera" || name == "a dimmed lamp")
        for (const char* counter :
             {"next_bytes_up", "next_bytes_down", "next_allocations", "next_syncs", "next_program_look_ups"})
          CHECK(next.counters.at(counter) == 0);
      REQUIRE(prepared->next(still, {1, {}}));  // and back
      CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.layers);
    }
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: a preparation stays as it is where the next scene is refused",
                 "[gpu][legendre_fluids]") {
  const auto still = lit_scene(smoke(random_density({3, 3, 3}, 3), 1), oblique_light, oblique_view, 8, 6);
  test::check_refused_frame(method, still, scene::PointLight{});
}

}  // namespace legendre_gpu_next_frame_test
