#include "reference/path_tracer/accumulation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

#include "reference/path_tracer/leaf.h"
#include "scene/base/error.h"
#include "scene/base/flush_subnormals.h"
#include "scene/base/limits.h"
#include "scene/base/threads.h"

namespace airlight::path_tracer {
namespace {

// Work items are kept below this many samples of a tile, so that a render can stop soon and threads end together.
constexpr int item_level = 8;
constexpr double most_items = 1 << 20;  // beyond them items are larger

struct Item {
  int tile;
  DyadicBlock block;
};

// Ranges of [begin, end) that no node covers.
std::vector<std::pair<std::uint64_t, std::uint64_t>> missing(const std::vector<TallyNode>& nodes, std::uint64_t begin,
                                                             std::uint64_t end) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps;
  for (const TallyNode& node : nodes) {
    if (node.end() <= begin) continue;
    if (node.begin() >= end) break;
    if (node.begin() > begin) gaps.emplace_back(begin, node.begin());
    begin = node.end();
  }
  if (begin < end) gaps.emplace_back(begin, end);
  return gaps;
}

// Samples of one leaf for all pixels of a tile.
TallyNode leaf(const World& world, const scene::View& view, const TallyLayout& layout, int tile, std::uint64_t index,
               std::uint64_t count, Counters& counters) {
  const int across = (view.width + tile_size - 1) / tile_size;
  const int x0 = tile % across * tile_size, y0 = tile / across * tile_size;
  const int x1 = std::min(x0 + tile_size, view.width), y1 = std::min(y0 + tile_size, view.height);
  TallyNode node{leaf_level, index, count, {}};
  node.sums.assign(std::size_t(layout.doubles()) * (x1 - x0) * (y1 - y0), 0.0);
  double* sums = node.sums.data();
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x, sums += layout.doubles()) {
      const auto pixel = std::uint32_t(y) * std::uint32_t(view.width) + std::uint32_t(x);
      const auto where = [&] { return fmt::format("pixel ({}, {})", x, y); };
      const auto ray_through = [&](double dx, double dy) {
        return scene::camera_ray(view.camera, x + dx, y + dy, view.width, view.height);
      };
      const std::uint64_t first = index << leaf_level;
      if (world.options().box_pixels)
        add_samples(
            world, [&](const RandomBlock& place) { return ray_through(place.fine(0), place.fine(1)); }, pixel, first,
            count, layout, sums, counters, where);
      else
        add_samples(world, prepare_camera_ray(world, ray_through(0.5, 0.5), counters), pixel, first, count, layout,
                    sums, counters, where);
    }
  return node;
}

}  // namespace

std::uint64_t Accumulation::least_samples() const {
  std::uint64_t least = ~std::uint64_t(0);
  for (const auto& nodes : tiles) {
    std::uint64_t count = 0;
    for (const TallyNode& node : nodes) count += node.count;
    least = std::min(least, count);
  }
  return tiles.empty() ? 0 : least;
}

Accumulation empty_accumulation(const World& world, const scene::View& view) {
  require_own_camera(world.scene(), view);
  if (view.width < 1 || view.height < 1 || std::uint64_t(view.width) * std::uint64_t(view.height) > 0xffffffffu)
    throw Error(fmt::format("path_tracer: film of {} x {}, expected 1 to 2^32 pixels", view.width, view.height));
  Accumulation a;
  a.identity = identity_of(world.scene(), view, world.options());
  a.width = view.width;
  a.height = view.height;
  a.layout = {world.options().orders, true};
  // Sums and film; up to 3.6 times the sums were measured where ranges wait for each other.
  scene::require_memory(2 * double(sizeof(double)) * a.layout.doubles() * double(view.width) * double(view.height),
                        fmt::format("path_tracer: a film of {} x {}", view.width, view.height));
  a.tiles.resize(std::size_t(a.tiles_across()) * a.tiles_down());
  return a;
}

bool render_range(const World& world, const scene::View& view, std::uint64_t begin, std::uint64_t end,
                  const scene::Execution& execution, Accumulation& accumulation, const std::vector<int>* tiles) {
  const auto start = std::chrono::steady_clock::now();
  // A leaf that ended an earlier range within a block is computed again, whole.
  for (auto& nodes : accumulation.tiles)
    std::erase_if(nodes, [&](const TallyNode& node) { return !node.complete() && node.end() < end; });
  std::vector<Item> items;
  const int tile_count = int(tiles ? tiles->size() : accumulation.tiles.size());
  int level = item_level;
  while (std::ldexp(double(end - begin) * tile_count, -level) > most_items) ++level;
  for (int n = 0; n < tile_count; ++n) {
    const int tile = tiles ? (*tiles)[n] : n;
    for (const auto& [from, to] : missing(accumulation.tiles[tile], begin, end))
      for (const DyadicBlock& block : dyadic_cover(from, to, level)) items.push_back({tile, block});
  }
  // Blocks of few samples first over the whole film: what an interruption leaves is even.
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.block.index << a.block.level < b.block.index << b.block.level;
  });

  double all = 0, done = 0;  // samples of a tile
  for (const Item& item : items) all += double(item.block.count);
  std::atomic<bool> stopped{false};
  std::mutex mutex;
  const auto tell = [&](std::uint64_t samples) {
    done += double(samples);
    if (execution.progress && !execution.progress(done / all)) stopped = true;
  };
  tbb::task_arena arena(scene::threads_for(execution.threads));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, items.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t n = range.begin(); n < range.end() && !stopped; ++n) {
            const auto& [tile, block] = items[n];
            Counters counters;
            std::vector<TallyNode> nodes;
            std::uint64_t told = 0;
            {
              const scene::FlushSubnormals flush;
              const std::uint64_t first = block.index << block.level;
              for (std::uint64_t at = 0; at < block.count && !stopped; at += leaf_samples) {
                if (at - told == std::uint64_t(1) << item_level) {
                  const std::lock_guard lock(mutex);
                  tell(at - told);
                  told = at;
                }
                insert(accumulation.layout, nodes,
                       leaf(world, view, accumulation.layout, tile, (first + at) >> leaf_level,
                            std::min(leaf_samples, block.count - at), counters));
              }
            }
            const std::lock_guard lock(mutex);
            if (counters.violations > 0)
              throw Error(
                  fmt::format("path_tracer: the density exceeded its majorant {} times in one block of samples: "
                              "the render is void",
                              counters.violations));
            for (TallyNode& node : nodes) insert(accumulation.layout, accumulation.tiles[tile], std::move(node));
            accumulation.counters += counters;
            tell(block.count - told);
          }
        },
        tbb::simple_partitioner());
  });
  accumulation.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return !stopped;
}

void merge_into(Accumulation& into, Accumulation other) {
  const std::string differs = difference(into.identity, other.identity);
  if (!differs.empty()) throw Error(fmt::format("ranges cannot be merged: {}", differs));
  if (into.width != other.width || into.height != other.height || !(into.layout == other.layout))
    throw Error("ranges cannot be merged: film size or layers differ");
  for (std::size_t tile = 0; tile < into.tiles.size(); ++tile)
    for (TallyNode& node : other.tiles[tile]) insert(into.layout, into.tiles[tile], std::move(node));
  into.counters += other.counters;
  into.seconds += other.seconds;
}

Accumulation merge_range_files(const std::vector<std::string>& paths) {
  if (paths.empty()) throw Error("merge: no range files");
  Accumulation all = read_range_file(paths[0]);
  for (std::size_t i = 1; i < paths.size(); ++i) {
    try {
      merge_into(all, read_range_file(paths[i]));
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", paths[i], error.what()));
    }
  }
  for (const auto& nodes : all.tiles)
    for (std::size_t n = 1; n < nodes.size(); ++n)
      if (nodes[n].begin() != nodes[n - 1].end())
        throw Error(fmt::format("merge: samples {}..{} are missing", nodes[n - 1].end(), nodes[n].begin()));
  return all;
}

}  // namespace airlight::path_tracer
