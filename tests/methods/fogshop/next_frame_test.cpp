// Prepared::next: frames whose lights or media have moved have the bits of a preparation of their own, and what did not change is kept.
#include <algorithm>

#include "tests/methods/fogshop/next_frames.h"
#include "tests/refused_frame.h"

namespace fogshop_next_frame_test {

using namespace airlight;
using fogshop::test::method;
using namespace fogshop_next_frames;

namespace {

Names names_of(const std::vector<scene::StageTime>& times) {
  Names names;
  for (const auto& [name, seconds] : times) names.push_back(name);
  return names;
}

}  // namespace

TEST_CASE("fogshop: the next frame is the frame made anew, and makes what changed alone", "[fogshop]") {
  const Pairs kinds[] = {everything,
                         {{"variant", "paper"}, {"reflectance", "sun"}},
                         {{"light_depth", "exact"}},
                         {{"downsample", "2"}, {"noise_scale", "0.3"}}};
  const auto still = std::make_shared<const Scene>(garden());
  for (const Pairs& given : kinds) {
    const scene::Settings settings(method.settings(), given);
    const auto prepared = method.prepare(still, settings, {1, {}});
    const scene::Film first = prepared->render(view_of(*still), {1, {}}).film;
    for (const Change& change : changes) {
      CAPTURE(given, change.name);
      const auto there = changed(*still, change);
      const auto times = prepared->next(there, {1, {}});
      REQUIRE(times);
      const scene::Rendering next = prepared->render(view_of(*there), {1, {}});
      const auto fresh = method.prepare(there, settings, {1, {}});
      const scene::Rendering anew = fresh->render(view_of(*there), {1, {}});
      CHECK(next.film.layers == anew.film.layers);
      CHECK((next.film.layers != first.layers) == !change.same_picture);
      CHECK(next.counters.at("erf_evaluations_prepare") <= anew.counters.at("erf_evaluations_prepare"));
      if (given == everything) {
        CHECK(names_of(*times) == change.made);
        CHECK(next.counters.at("light_maps_made") == change.maps_made);
      }
      for (const auto& [stages, others] : {std::pair{prepared->stages(), fresh->stages()}})
        for (std::size_t i = 0; i < stages.size(); ++i) CHECK(stages[i].kept == others[i].kept);
      REQUIRE(prepared->next(still, {1, {}}));  // and back
      CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.layers);
    }
  }
}

TEST_CASE("fogshop: a preparation stays as it is where the next scene is refused", "[fogshop]") {
  const auto still = std::make_shared<const Scene>(garden());
  test::check_refused_frame(method, still, scene::DirectionalLight{});
}

}  // namespace fogshop_next_frame_test
