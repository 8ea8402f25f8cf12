// Prepared::next: frames whose lights, media or surfaces have changed have the bits of a preparation of their own, and columns towards lights
// that have not changed are kept.
#include <catch2/catch.hpp>

#include "methods/legendre_fluids/light.h"
#include "tests/methods/legendre_fluids/next_frames.h"
#include "tests/refused_frame.h"

namespace legendre_next_frame_test {

using namespace airlight;
using namespace legendre_next_frames;

namespace {
const legendre_fluids::LegendreLight method;
}

TEST_CASE("legendre fluids: the next frame is the frame made anew, and makes what changed alone", "[legendre_fluids]") {
  const auto still = std::make_shared<const Scene>(smoke_over_floor());
  const scene::Settings settings(method.settings(), given);
  const auto prepared = method.prepare(still, settings, {1, {}});
  const scene::Rendering first = prepared->render(view_of(*still), {1, {}});
  CHECK(first.counters.at("columns_made") == 2 * all_lights);
  for (const Change& change : changes) {
    CAPTURE(change.name);
    const auto there = changed(*still, change);
    const auto times = prepared->next(there, {1, {}});
    REQUIRE(times);
    CHECK(times->empty() == (change.columns_made == 0));
    const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
    const auto fresh = method.prepare(there, settings, {1, {}});
    const scene::Rendering anew = fresh->render(view_of(*there), {1, {}});
    CHECK(next.film.layers == anew.film.layers);
    CHECK(next.counters.at("columns_made") == change.columns_made);
    for (const char* counter : {"segments", "panels", "shadow_rays", "negative_share"})
      CHECK(next.counters.at(counter) == anew.counters.at(counter));
    CHECK((next.film.layers == first.film.layers) == change.same);
    const auto stages = prepared->stages(), others = fresh->stages();
    for (std::size_t i = 0; i < stages.size(); ++i) CHECK(stages[i].reason == others[i].reason);
    REQUIRE(prepared->next(still, {1, {}}));  // and back
    CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.film.layers);
  }
}

TEST_CASE("legendre fluids: the paper's systems of the next frame are solved where lamps or densities changed",
          "[legendre_fluids]") {
  const auto still = std::make_shared<const Scene>(smoke_for_systems());
  for (const char* closure : {"least_squares", "upwind"}) {
    const scene::Settings settings(method.settings(), {{"variant", "paper"}, {"n", "4"}, {"closure", closure}});
    const auto prepared = method.prepare(still, settings, {1, {}});
    const scene::Rendering first = prepared->render(view_of(*still), {1, {}});
    CHECK(first.counters.at("direct_systems_made") == 2);
    for (const PaperChange& change : paper_changes) {
      CAPTURE(closure, change.name);
      const auto there = changed(*still, change);
      const auto times = prepared->next(there, {1, {}});
      REQUIRE(times);
      CHECK(times->empty() == (change.systems_made == 0));
      const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
      const scene::Rendering anew = method.prepare(there, settings, {1, {}})->render(view_of(*there), {1, {}});
      CHECK(next.film.layers == anew.film.layers);
      CHECK((next.film.layers == first.film.layers) == change.same);
      if (!there->media.empty()) {
        CHECK(next.counters.at("direct_systems_made") == change.systems_made);
        CHECK(next.counters.at("negative_direct_share") == anew.counters.at("negative_direct_share"));
      }
      REQUIRE(prepared->next(still, {1, {}}));  // and back
      CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.film.layers);
    }
  }
}

TEST_CASE("legendre fluids: a preparation stays as it is where the next scene is refused", "[legendre_fluids]") {
  const auto still = std::make_shared<const Scene>(smoke_over_floor());
  test::check_refused_frame(method, still, scene::PointLight{}, given);
}

}  // namespace legendre_next_frame_test
