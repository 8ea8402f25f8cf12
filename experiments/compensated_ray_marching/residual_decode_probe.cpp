#include "experiments/compensated_ray_marching/residual_decode_probe.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "gpu/compensated_ray_marching/residual_store.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/residual.h"
#include "scene/math/random.h"

namespace airlight::experiments {
namespace {

using Eigen::Vector3i;
using gpu::compensated_ray_marching::ResidualOnDevice;
using Levels = std::vector<std::int8_t>;
using Points = std::vector<Eigen::Vector4f>;  // in samples; the last is not read

enum class DeviceStore { grid, bricks, hash_tags, hash_domain };
const scene::Choices<DeviceStore> device_stores{{"grid", DeviceStore::grid},
                                                {"bricks", DeviceStore::bricks},
                                                {"hash_tags", DeviceStore::hash_tags},
                                                {"hash_domain", DeviceStore::hash_domain}};

std::unique_ptr<ResidualOnDevice> store_of(gpu::Context& context, DeviceStore store, const Vector3i& size,
                                           const Levels& levels) {
  if (store == DeviceStore::grid) return std::make_unique<ResidualOnDevice>(context, size, levels);
  if (store == DeviceStore::bricks)
    return std::make_unique<ResidualOnDevice>(context, size, scene::apron_bricks_of(size, levels));
  return std::make_unique<ResidualOnDevice>(
      context, size, scene::perfect_hash(size, scene::hashed_voxels(size, levels)),
      store == DeviceStore::hash_tags ? ResidualOnDevice::Membership::tags : ResidualOnDevice::Membership::domain);
}

Points random_points(const Vector3i& size, int count) {
  Points points;
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
    const PhiloxCounter w = philox4x32_10({i, 0, 0, 0}, {42, 1});
    points.emplace_back(size[0] * uniform32(w[0]), size[1] * uniform32(w[1]), size[2] * uniform32(w[2]), 0);
  }
  return points;
}

// Half a sample apart along x, rows of the middle of cells one after the other: as a march.
Points consecutive_points(const Vector3i& size, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const int x = i % (2 * size[0]), y = i / (2 * size[0]) % size[1], z = i / (2 * size[0]) / size[1] % size[2];
    points.emplace_back(0.5f * float(x), float(y) + 0.5f, float(z) + 0.5f, 0);
  }
  return points;
}

// Seconds of each run until the device is done; the first is left out.
template <class Work>
std::vector<double> timed(gpu::Context& context, int runs, Work&& work) {
  std::vector<double> seconds;
  scene::Stopwatch watch;
  for (int run = -1; run < runs; ++run) {
    context.wait();
    watch.lap();
    work();
    context.wait();
    if (const double lap = watch.lap(); run >= 0) seconds.push_back(lap);
  }
  return seconds;
}

class Decoder {
 public:
  Decoder(gpu::Context& context, const ResidualOnDevice& residual, int runs)
      : context_(context), residual_(residual), runs_(runs) {}

  // Levels of all samples, x fastest.
  std::vector<double> all_levels(const Vector3i& size) const {
    return run(false, int(size.prod()), [&](gpu::Program& program) {
      program.set("first", Vec3(Vec3::Zero()));
      program.set("box", Vec3(size.cast<double>()));
    });
  }
  // Between levels, at points.
  std::vector<double> between(const Points& points) const {
    std::vector<float> flat;
    flat.reserve(4 * points.size());
    for (const Eigen::Vector4f& p : points) flat.insert(flat.end(), p.begin(), p.end());
    const gpu::Buffer buffer(context_, "points", flat);
    return run(true, int(points.size()),
               [&](gpu::Program&) { buffer.bind(gpu::compensated_ray_marching::at::residual_points); });
  }

 private:
  template <class Bind>
  std::vector<double> run(bool between, int count, Bind&& bind) const {
    auto definitions = residual_.definitions();
    definitions.insert({{"LOCAL_SIZE_X", "64"}, {"BETWEEN", between ? "1" : "0"}});
    gpu::Program& program = context_.program("compensated_ray_marching/residual_levels.comp", definitions);
    const gpu::Buffer result(context_, "levels", 4 * std::size_t(count));
    result.bind(gpu::compensated_ray_marching::at::residual_result);
    residual_.bind(program);
    bind(program);
    program.set("count", count);
    std::vector<double> nanoseconds = timed(context_, runs_, [&] { program.dispatch(count); });
    for (double& time : nanoseconds) time *= 1e9 / count;
    return nanoseconds;
  }

  gpu::Context& context_;
  const ResidualOnDevice& residual_;
  int runs_;
};

// How far what the device has between levels is from the processor's, at most [levels]. Throws Error for a level that is another one.
double worst_of(gpu::Context& context, const ResidualOnDevice& residual, const Vector3i& size, const Levels& levels,
                const Points& points) {
  const std::vector<int> got = levels_on_device(context, residual, Vector3i::Zero(), size);
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (got[i] != levels[i])
      throw Error(fmt::format("residual_decode_gpu: sample {} is level {}, expected {}", i, got[i], int(levels[i])));
  const scene::ApronBricks bricks = scene::apron_bricks_of(size, levels);
  const std::vector<float> between = levels_between_on_device(context, residual, points);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    worst = std::max(worst, std::abs(between[i] - level_between(bricks, points[i].head<3>().cast<double>())));
  return worst;
}

}  // namespace

std::string ResidualDecode::about() const {
  return "look-ups in a residual on the device: grid, bricks with an apron, perfect hash; Zhou et al. 2008, section 5.2";
}

std::vector<scene::SettingSpec> ResidualDecode::settings() const {
  return {scene::choice_setting(
              "store", DeviceStore::bricks, device_stores,
              "grid: all levels; bricks of 8^3 cells; hash_tags, hash_domain: how it tells what is stored"),
          scene::choice_setting("smoke", "scene", {"scene", "noise"}, "the grid of the scene's medium, or curl noise"),
          scene::integer_setting("size", "64", 8, 256, "samples along a side of the curl noise"),
          scene::integer_setting("gaussians", "400", 0, 100000, "that the residual is against"),
          scene::integer_setting("threshold", "0", 0, 126, "levels of this size or less are dropped"),
          scene::integer_setting("lookups", "1000000", 1, 1e7,
                                 "between levels that are timed, random and one after another"),
          scene::integer_setting("runs", "9", 1, 1000, "timed")};
}

std::vector<std::string> ResidualDecode::figures() const {
  return {"device_kB", "level_ns", "between_ns", "between_random_ns", "worst_between"};
}

Findings ResidualDecode::run(const ProbeInput& input, const scene::Settings& s,
                             const scene::Execution& execution) const {
  gpu::Context& context = gpu::Context::get();
  const gpu::Use use(context);
  const scene::VoxelGrid grid = s.text("smoke") == "scene" ? grid_of_scene(input) : noise_smoke(int(s.integer("size")));
  scene::QuantisationOptions options;
  options.threshold = int(s.integer("threshold"));
  const scene::Residual residual =
      scene::residual_of(grid, gaussians_for(grid, int(s.integer("gaussians")), execution), options);
  const Vector3i size = residual.layout.size;
  const Levels levels = levels_of(residual.bricks);
  const auto store = store_of(context, s.choice("store", device_stores), size, levels);
  const int lookups = int(s.integer("lookups"));
  const Points random = random_points(size, lookups);
  const Decoder decoder(context, *store, int(s.integer("runs")));
  const std::vector<double> march = decoder.between(consecutive_points(size, lookups));
  Findings found;
  found.figures = {exactly("device_kB", 1e-3 * double(store->bytes())), measured("level_ns", decoder.all_levels(size)),
                   measured("between_ns", march), measured("between_random_ns", decoder.between(random)),
                   exactly("worst_between", worst_of(context, *store, size, levels, random))};
  std::vector<double> seconds = march;
  for (double& time : seconds) time *= 1e-9 * lookups;
  set_time(found, seconds);
  return found;
}

}  // namespace airlight::experiments
