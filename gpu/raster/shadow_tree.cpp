#include "gpu/raster/shadow_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "gpu/raster/occluders.h"

namespace airlight::gpu {

struct ShadowTree::Data {
  int nodes = 0, solids = 0;
  double reach = 0;
  Point3 middle = Point3::Zero();
  std::array<float, 3> low = {0, 0, 0};
  float cell = 1;
  std::vector<int> words;
};

namespace {

constexpr int node_words = 20;                 // of raster/tree.glsl
constexpr std::int64_t cells = (1 << 21) - 1;  // to a side

// 21 bits a coordinate.
std::array<int, 2> packed(const std::array<float, 3>& corner, const std::array<float, 3>& low, float cell, bool up) {
  std::uint64_t bits = 0;
  for (int a = 0; a < 3; ++a) {
    const double at = (double(corner[a]) - low[a]) / cell;
    bits |= std::uint64_t(std::clamp<std::int64_t>(std::int64_t(up ? std::ceil(at) : std::floor(at)), 0, cells))
            << (21 * a);
  }
  return std::bit_cast<std::array<int, 2>>(bits);
}

// For an octant of directions (bit a: towards lower coordinates): the child that comes first, or the leaf, and the node that
// follows when `node` is done with.
void link(const std::vector<OccluderNode>& nodes, int octant, int node, int next, std::vector<int>& words) {
  int* links = &words[node_words * node + 4 + 2 * octant];
  links[1] = next;
  if (nodes[node].leaf >= 0) {
    links[0] = -1 - nodes[node].leaf;
    return;
  }
  const int code = -1 - nodes[node].leaf;
  int first = node + 1, second = code >> 2;
  if (octant >> (code & 3) & 1) std::swap(first, second);
  links[0] = first;
  link(nodes, octant, first, second, words);
  link(nodes, octant, second, next, words);
}

}  // namespace

ShadowTree::Data ShadowTree::data(const scene::Scene& scene) {
  Data data;
  if (!scene.geometry) return data;
  if (const Box box = scene.geometry->bounds(); !box.empty()) data.middle = box.center();
  const Occluders occluders = make_occluders(scene.surfaces, data.middle);
  data.nodes = int(occluders.nodes.size());
  data.solids = int(std::count_if(scene.surfaces.begin(), scene.surfaces.end(), [](const scene::Surface& surface) {
    return !std::holds_alternative<scene::TriangleMesh>(surface.shape);
  }));
  if (data.nodes == 0) return data;
  const OccluderNode& all = occluders.nodes[0];
  double extent = 0;
  for (int a = 0; a < 3; ++a) {
    data.reach = std::max({data.reach, -double(all.lo[a]), double(all.hi[a])});
    extent = std::max(extent, double(all.hi[a]) - all.lo[a]);
  }
  data.low = all.lo;
  if (extent > 0) data.cell = float(extent * (1 + 1e-6) / double(cells));
  data.words.resize(node_words * occluders.nodes.size() + 12 * occluders.triangles.size());
  for (int i = 0; i < data.nodes; ++i) {
    int* words = &data.words[node_words * i];
    const auto lo = packed(occluders.nodes[i].lo, data.low, data.cell, false),
               hi = packed(occluders.nodes[i].hi, data.low, data.cell, true);
    std::copy(lo.begin(), lo.end(), words);
    std::copy(hi.begin(), hi.end(), words + 2);
  }
  for (int octant = 0; octant < 8; ++octant) link(occluders.nodes, octant, 0, data.nodes, data.words);
  static_assert(sizeof(OccluderTriangle) == 12 * sizeof(int));
  if (!occluders.triangles.empty())
    std::memcpy(&data.words[node_words * data.nodes], occluders.triangles.data(), 48 * occluders.triangles.size());
  return data;
}

ShadowTree::ShadowTree(Context& context, const scene::Scene& scene) : ShadowTree(context, data(scene)) {}

ShadowTree::ShadowTree(Context& context, const Data& data)
    : nodes_(data.nodes),
      solids_(data.solids),
      middle_(data.middle),
      reach_(data.reach),
      low_(data.low[0], data.low[1], data.low[2]),
      cell_(data.cell),
      tree_(context, "tree of surfaces", data.words) {}

void ShadowTree::bind(LinkedProgram& program) const {
  tree_.bind(14);
  program.set("tree_nodes", nodes_);
  program.set_double("tree_middle", middle_);
  program.set("tree_reach", reach_);
  program.set("tree_low", low_);
  program.set("tree_cell", double(cell_));
  program.set("solid_count", solids_);
}

}  // namespace airlight::gpu
