// Buffers that a Prepared keeps from frame to frame: warm frames allocate nothing, wait once, and
// download only the wanted layers.
#include "gpu/frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/program.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"

namespace frame_test {

using namespace airlight;
using namespace airlight::gpu;

namespace {

const char* const numbering = R"(layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = 0) buffer Values { float values[]; };
uniform float first;
void main() { values[gl_GlobalInvocationID.x] = first + float(gl_GlobalInvocationID.x); }
)";

// A film of 8 x 8 pixels whose layers count from a number on.
scene::Rendering draw(Frame& frame, Program& program, const scene::Execution& execution) {
  scene::Rendering rendering{scene::Film(8, 8), {}, {}};
  const std::size_t values = 3 * rendering.film.pixels();
  frame.begin(execution);
  for (const char* layer : {"mean", "surface"}) {
    frame.timer.begin(layer);
    Buffer& buffer = frame.buffers.get(layer, 4 * values);
    buffer.bind(0);
    program.set("first", layer == std::string("mean") ? 1000.0 : 2000.0);
    program.dispatch(int(values));
    frame.download.add(layer, buffer, 4 * values);
  }
  frame.download.add_values("two", frame.buffers.get("mean", 4 * values), 8);
  frame.finish(rendering);
  return rendering;
}

std::vector<std::string> names(const scene::Rendering& rendering) {
  std::vector<std::string> result;
  for (const scene::StageTime& time : rendering.times) result.push_back(time.name);
  return result;
}

}  // namespace

DEVICE_TEST_CASE("a warm frame allocates nothing, waits once and brings down what is wanted", "[gpu]") {
  const Use use(context);
  const test::ShaderFolder shaders(numbering);
  Program program(context, "test.comp", {{"LOCAL_SIZE_X", "64"}});
  Frame frame(context);

  scene::Rendering all = draw(frame, program, {});
  CHECK(all.counters["allocations"] >= 3);  // two layers, the mapped buffer
  all = draw(frame, program, {});
  CHECK(names(all) == std::vector<std::string>{"mean", "surface", "download"});
  CHECK(all.counters["allocations"] == 0);
  CHECK(all.counters["syncs"] == 1);
  CHECK(all.counters["bytes_up"] == 0);
  CHECK(all.counters["bytes_down"] == 2 * 768 + 8);
  CHECK(all.counters["dispatches"] == 2);
  CHECK(all.counters["program_look_ups"] == 0);
  for (int i = 0; i < 192; ++i) {
    CHECK(all.film.layer("mean")[i] == 1000.0f + float(i));
    CHECK(all.film.layer("surface")[i] == 2000.0f + float(i));
  }
  CHECK(frame.download.values<float>("two") == std::vector<float>{1000, 1001});

  scene::Execution one;
  one.layers = {"surface"};
  scene::Rendering surface = draw(frame, program, one);
  CHECK(surface.film.layers.size() == 1);
  CHECK(surface.film.layer("surface")[191] == 2191);
  CHECK(surface.counters["bytes_down"] == 768 + 8);

  scene::Execution none;
  none.layers.emplace();
  scene::Rendering nothing = draw(frame, program, none);
  CHECK(names(nothing) == std::vector<std::string>{"mean", "surface"});
  CHECK(nothing.film.layers.empty());
  CHECK(nothing.counters["bytes_down"] == 0);
  CHECK(nothing.counters["syncs"] == 1);
  CHECK(nothing.counters["allocations"] == 0);
  CHECK(frame.download.values<float>("two").empty());
}

DEVICE_TEST_CASE("a frame's buffers follow their size and hold poison where asked", "[gpu]") {
  const Use use(context);
  FrameBuffers buffers(context);
  const long before = context.traffic().allocations;
  Buffer* first = &buffers.get("a", 64);
  CHECK(&buffers.get("a", 64) == first);
  CHECK(context.traffic().allocations - before == 1);
  CHECK(buffers.get("a", 128).bytes() == 128);
  CHECK(context.traffic().allocations - before == 2);
  buffers.poison();
  for (const float value : buffers.get("a", 128).download<float>()) CHECK(std::isnan(value));
  buffers.get("a", 128).clear();
  for (const float value : buffers.get("a", 128).download<float>()) CHECK(value == 0);
}

}  // namespace frame_test
