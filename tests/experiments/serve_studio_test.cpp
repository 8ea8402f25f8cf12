// Frames and references of `airlight serve`: those of `render` and of the experiments, and none that nobody waits for.
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "experiments/application/machine.h"
#include "experiments/serve/answers.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/serving.h"

namespace serve_studio_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::experiments;
using namespace airlight::experiments::serve;
using Catch::Contains;

TEST_CASE("Serve: a pane shows what render gives, whatever moved before", "[experiments][serve]") {
  const std::string file = scenes + "common/lamp_in_patches.toml";
  Studio studio({file}, 0);
  for (const char* method : {"fogshop", "froxel_fog", "ray_marcher"}) {
    FrameRequest request = request_of(method);
    for (const scene::Overrides& values : {scene::Overrides{},
                                           {{"light.0.position", "[0.1, 1.3, 0.2]"}},
                                           {{"camera.position", "[1, 4, 4]"}},
                                           {{"medium.0.sigma_t", "0.7"}, {"camera.position", "[1, 4, 4]"}}}) {
      request.values = values;
      INFO(method << " " << (values.empty() ? "" : values.begin()->first));
      const auto frame = studio.frame(request);
      REQUIRE(frame);
      REQUIRE(frame->refused.empty());
      const Answer answer = unpacked(frame_answer(frame, request));
      CHECK(difference(answer.values, rendered(file, request).layer("mean")) < 1e-3);
      CHECK(!frame->stages.empty());
      CHECK(frame->median > 0);
    }
  }
}

TEST_CASE("Serve: what is prepared is kept, moved on, or made anew", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest request = request_of("fogshop");
  const auto prepared = [&] { return studio.frame(request).value().prepared; };
  CHECK(prepared() == "anew");
  CHECK(prepared() == "kept");
  request.values = {{"light.0.position", "[0.1, 1.3, 0.2]"}};
  CHECK(prepared() == "moved on");
  request.settings = {{"variant", "paper"}};
  CHECK(prepared() == "anew");
  for (int i = 0; i < 40; ++i) CHECK(prepared() == "kept");
  CHECK(studio.frame(request)->median_frames == 30);
}

TEST_CASE("Serve: refusals and bad settings are told", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  CHECK_THAT(studio.frame(request_of("legendre_fluids"))->refused, Contains("gaussians"));
  CHECK(unpacked(frame_answer(studio.frame(request_of("legendre_fluids")), request_of("legendre_fluids")))
            .head.contains("refused"));
  FrameRequest request = request_of("fogshop");
  request.settings = {{"variant", "none"}};
  CHECK_THAT(message_of([&] { studio.frame(request); }), Contains("variant"));
  CHECK_THAT(message_of([&] { studio.frame(request_of("fogshopp")); }), Contains("nearest: fogshop"));
  request = request_of("fogshop");
  request.layer = "ambient";
  CHECK_THAT(studio.frame(request)->refused, Contains("ambient"));
}

TEST_CASE("Serve: the reference and its errors are those of the experiments", "[experiments][serve]") {
  const std::string file = scenes + "common/lamp_in_patches.toml";
  Studio studio({file}, 0);
  ReferenceRequest wanted;
  wanted.client = "c";
  wanted.width = 24;
  wanted.height = 18;
  const FrameRequest request = request_of("ray_marcher");
  studio.frame(request);
  ReferenceState state;
  for (int i = 0; i < 600 && state.samples < 64; ++i) {
    state = studio.reference(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  REQUIRE(state.film);
  REQUIRE(state.errors.count("left"));
  const scene::Film marched = rendered(file, request);
  CHECK(state.errors["left"].missing.empty());
  const Measure& live = state.errors["left"].measure;
  const auto scene = scene::load_scene(file, {{"film.width", "24"}, {"film.height", "18"}});
  const Measure ours =
      measure({"rel_l2"}, marched, *state.film, "mean", {scene::ball_mask(scene, scene::view_of(scene)), {}}).front();
  CHECK(live.value == ours.value);
  CHECK(live.low == ours.low);
  CHECK(live.high == ours.high);
  FrameRequest traced = request_of("path_tracer");
  traced.settings = {{"stream", "255"}, {"samples", std::to_string(state.samples)}};
  CHECK(state.film->layer("mean") == rendered(file, traced).layer("mean"));
  // It goes on while nothing else is asked for, and begins anew where the camera moved.
  const auto before = state.samples;
  for (int i = 0; i < 600 && state.samples <= before; ++i) {
    state = studio.reference(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  CHECK(state.samples > before);
  wanted.values = {{"camera.position", "[1, 4, 4]"}};
  CHECK(studio.reference(wanted).samples == 0);
}

TEST_CASE("Serve: a newer request takes the place of an older one", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest slow = request_of("path_tracer", 160, 120);
  slow.settings = {{"samples", "1000000"}};
  std::optional<Frame> first = Frame();
  std::thread waiting([&] { first = studio.frame(slow); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto start = std::chrono::steady_clock::now();
  CHECK(studio.frame(request_of("fogshop")).has_value());
  waiting.join();
  CHECK(!first);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("Serve: a client that leaves has nothing running", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest slow = request_of("path_tracer", 160, 120);
  slow.settings = {{"samples", "1000000"}};
  std::optional<Frame> frame = Frame();
  std::thread waiting([&] { frame = studio.frame(slow); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  studio.leave("c");
  waiting.join();
  CHECK(!frame);
  const double before = processor_time().run;
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  CHECK(processor_time().run - before < 0.35);
}

}  // namespace serve_studio_test
