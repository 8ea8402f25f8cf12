#include "gpu/shadow_planes/tile_bins.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/program.h"
#include "gpu/view_uniforms.h"
#include "scene/error.h"

namespace airlight::gpu {

void TileBins::fill(const scene::View& view, const Point3& light, const LightEdges& edges) {
  const Use use(context_);
  fill(blocks_, nullptr, block, view, light, edges);
  entries_ = fill(tiles_, &blocks_, tile, view, light, edges);
}

int TileBins::fill(Level& level, const Level* parent, int side, const scene::View& view, const Point3& light,
                   const LightEdges& edges) {
  constexpr int threads = 64;
  const int columns = (view.width + side - 1) / side, rows = (view.height + side - 1) / side;
  const std::size_t range_bytes = std::size_t(columns) * rows * 8;
  if (!level.ranges || level.ranges->bytes() < range_bytes)
    level.ranges = std::make_unique<Buffer>(context_, "tiles", range_bytes);
  // Most edges are short and lie in the shadow planes of few tiles.
  if (!level.lists) level.lists = std::make_unique<Buffer>(context_, "lists of tiles", 4 * (4096 + 8 * edges.count));
  for (;;) {
    needed_.upload(std::vector<int>{0});
    edges.edges->bind(0);
    if (parent) {
      parent->ranges->bind(1);
      parent->lists->bind(2);
    }
    level.ranges->bind(3);
    level.lists->bind(4);
    needed_.bind(6);
    Program& p = context_.program("shadow_planes/bins.comp", {{"LOCAL_SIZE_X", std::to_string(threads)},
                                                              {"PARENT", std::to_string(parent ? block / tile : 0)}});
    set_view(p, view);
    p.set_double("light", light);
    p.set("edge_count", edges.count);
    p.set("columns", columns);
    p.set("block_side", side);
    p.set("list_room", int(level.lists->bytes() / 4));
    p.dispatch(columns * threads, rows);
    const int needed = needed_.download<int>().front();
    if (std::size_t(needed) * 4 <= level.lists->bytes()) return needed;
    const std::size_t most = context_.limits().storage_block;
    if (needed < 0 || std::size_t(needed) * 4 > most)
      throw Unavailable(
          fmt::format("gpu: the lists of {} silhouette edges in {} tiles pass the {} bytes of a storage block of {}",
                      edges.count, columns * rows, most, context_.renderer()));
    ++overflows_;
    const std::size_t room = std::size_t(needed) + std::size_t(needed) / 4;
    level.lists = std::make_unique<Buffer>(context_, "lists of tiles", std::min(most / 4, room) * 4);
  }
}

void TileBins::bind() const {
  tiles_.ranges->bind(3);
  tiles_.lists->bind(4);
}

}  // namespace airlight::gpu
