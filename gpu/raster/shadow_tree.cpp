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
  std::vector<int> words;
};

namespace {

constexpr int node_entries = 11, node_words = 2 * node_entries;  // of raster/tree.glsl

// For an octant of directions (bit a: towards lower coordinates): the child that comes first, or the leaf, and the node that
// follows when `node` is done with.
void link(const std::vector<OccluderNode>& nodes, int octant, int node, int next, std::vector<int>& words) {
  int* links = &words[node_words * node + 6 + 2 * octant];
  links[1] = node_entries * next;
  if (nodes[node].leaf >= 0) {
    links[0] = -1 - nodes[node].leaf;
    return;
  }
  const int code = -1 - nodes[node].leaf;
  int first = node + 1, second = code >> 2;
  if (octant >> (code & 3) & 1) std::swap(first, second);
  links[0] = node_entries * first;
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
  for (int a = 0; a < 3; ++a) data.reach = std::max({data.reach, -double(all.lo[a]), double(all.hi[a])});
  data.words.resize(node_words * occluders.nodes.size() + 12 * occluders.triangles.size());
  for (int i = 0; i < data.nodes; ++i) {
    int* words = &data.words[node_words * i];
    for (int a = 0; a < 3; ++a) {
      words[a] = std::bit_cast<int>(occluders.nodes[i].lo[a]);
      words[3 + a] = std::bit_cast<int>(occluders.nodes[i].hi[a]);
    }
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
      tree_(context, "tree of surfaces", data.words) {}

void ShadowTree::bind(LinkedProgram& program) const {
  tree_.bind(14);
  program.set("tree_end", node_entries * nodes_);
  program.set_double("tree_middle", middle_);
  program.set("tree_reach", reach_);
  program.set("solid_count", solids_);
}

}  // namespace airlight::gpu
