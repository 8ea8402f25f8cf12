#include "reference/path_tracer/single_rays.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <mutex>

#include "scene/base/error.h"
#include "scene/base/flush_subnormals.h"
#include "scene/base/threads.h"

namespace airlight::path_tracer {
namespace {

constexpr int item_level = 10;  // samples of one work item: 2^10

Rgb entry(const TallyNode& node, int e) { return {node.sums[3 * e], node.sums[3 * e + 1], node.sums[3 * e + 2]}; }

Estimate estimate(const Rgb& sum, const Rgb& square, double n) {
  const Rgb error = n < 2 ? Rgb(Rgb::Zero()) : Rgb(((square - sum * sum / n).max(0.0) / (n * (n - 1))).sqrt());
  return {sum / n, error};
}

// `add` computes the samples of one leaf.
template <class Add>
RadianceEstimate run(const World& world, std::uint64_t samples, const scene::Execution& execution, Add add) {
  if (samples == 0) throw Error("path_tracer: 0 samples, expected at least 1");
  const TallyLayout layout{world.options().orders, true};
  const std::vector<DyadicBlock> blocks = dyadic_cover(0, samples, item_level);
  std::vector<TallyNode> nodes;
  Counters counters;
  std::mutex mutex;
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  tbb::task_arena arena(scene::threads_for(execution.threads));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t b = range.begin(); b < range.end() && !stopped; ++b) {
            const std::uint64_t first = blocks[b].index << blocks[b].level;
            std::vector<TallyNode> local;
            Counters counted;
            {
              const scene::FlushSubnormals flush;
              for (std::uint64_t at = 0; at < blocks[b].count; at += leaf_samples) {
                TallyNode node{
                    leaf_level, (first + at) >> leaf_level, std::min(leaf_samples, blocks[b].count - at), {}};
                node.sums.assign(layout.doubles(), 0.0);
                add(first + at, node.count, layout, node.sums.data(), counted);
                insert(layout, local, std::move(node));
              }
            }
            const std::lock_guard lock(mutex);
            for (TallyNode& node : local) insert(layout, nodes, std::move(node));
            counters += counted;
            if (execution.progress && !execution.progress(double(++done) / double(blocks.size()))) stopped = true;
          }
        },
        tbb::simple_partitioner());
  });
  if (stopped) throw scene::Interrupted("interrupted");
  if (counters.violations > 0)
    throw Error(fmt::format("path_tracer: the density exceeded its majorant {} times: the result is void",
                            counters.violations));

  const TallyNode total = fold(layout, nodes);
  const double n = double(total.count);
  RadianceEstimate result;
  result.samples = total.count;
  result.total = estimate(entry(total, layout.mean()), entry(total, layout.square()), n);
  for (int m = 0; m <= layout.orders + 1; ++m)
    result.orders.push_back(estimate(entry(total, layout.order(m)), entry(total, layout.order_square(m)), n));
  result.airlight = entry(total, layout.airlight()) / n;
  result.surface = entry(total, layout.surface()) / n;
  result.truncated = entry(total, layout.truncated()) / n;
  result.greatest = entry(total, layout.greatest());
  if (total.count % batch_count == 0)
    for (int b = 0; b < batch_count; ++b) result.batches.push_back(entry(total, layout.batch(b)) * (batch_count / n));
  result.counters = counters;
  return result;
}

}  // namespace

RadianceEstimate radiance(const World& world, const Ray& ray, std::uint64_t samples, const scene::Execution& execution,
                          std::uint32_t index) {
  Counters counters;
  const CameraRay camera = prepare_camera_ray(world, ray, counters);
  const auto where = [&] { return fmt::format("ray {}", index); };
  return run(world, samples, execution,
             [&](std::uint64_t first, std::uint64_t count, const TallyLayout& layout, double* sums, Counters& counted) {
               add_samples(world, camera, index, first, count, layout, sums, counted, where);
             });
}

RadianceEstimate mean_radiance(const World& world, const RaySource& source, std::uint64_t samples,
                               const scene::Execution& execution, std::uint32_t index) {
  const auto where = [&] { return fmt::format("detector {}", index); };
  return run(world, samples, execution,
             [&](std::uint64_t first, std::uint64_t count, const TallyLayout& layout, double* sums, Counters& counted) {
               add_samples(world, source, index, first, count, layout, sums, counted, where);
             });
}

}  // namespace airlight::path_tracer
