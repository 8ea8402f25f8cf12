#include "reference/path_tracer/leaf.h"

#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::path_tracer {
namespace {

// The layer of a sample that is no number, or whose sum is none, and its value.
std::string not_finite(const PathSample& sample) {
  const auto say = [](const std::string& name, const Rgb& value) {
    return fmt::format("{} is ({}, {}, {})", name, value[0], value[1], value[2]);
  };
  for (int m = 0; m <= sample.K + 1; ++m)
    if (!sample.order[m].isFinite().all())
      return say(m <= sample.K ? fmt::format("order.{}", m) : "order.rest", sample.order[m]);
  if (!sample.truncated.isFinite().all()) return say("truncated", sample.truncated);
  return say("mean", sample.total());
}

template <class Camera>
void add_all(const World& world, Camera&& camera_of, std::uint32_t pixel, std::uint64_t first, std::uint64_t count,
             const TallyLayout& layout, double* sums, Counters& counters, const std::function<std::string()>& where) {
  const Options& options = world.options();
  for (std::uint64_t i = 0; i < count; ++i) {
    const SampleRandom random(options.seed, options.stream, pixel, first + i);
    PathSample sample(layout.orders);
    trace(world, camera_of(random), random, sample, counters);
    if (!add_sample(layout, sample, int(i * batch_count / count), sums))
      throw Error(
          fmt::format("path_tracer: scene '{}', {}, sample {}: layer {}, expected a finite radiance below 1e154 (does "
                      "the ray meet a light of radius 0 in a medium, or are lights or distances extreme?)",
                      world.scene().name, where(), first + i, not_finite(sample)));
  }
}

}  // namespace

void add_samples(const World& world, const CameraRay& camera, std::uint32_t pixel, std::uint64_t first,
                 std::uint64_t count, const TallyLayout& layout, double* sums, Counters& counters,
                 const std::function<std::string()>& where) {
  add_all(
      world, [&](const SampleRandom&) -> const CameraRay& { return camera; }, pixel, first, count, layout, sums,
      counters, where);
}

void add_samples(const World& world, const RaySource& source, std::uint32_t pixel, std::uint64_t first,
                 std::uint64_t count, const TallyLayout& layout, double* sums, Counters& counters,
                 const std::function<std::string()>& where) {
  add_all(
      world,
      [&](const SampleRandom& random) {
        return prepare_camera_ray(world, source(random.block(0, Purpose::camera)), counters);
      },
      pixel, first, count, layout, sums, counters, where);
}

}  // namespace airlight::path_tracer
