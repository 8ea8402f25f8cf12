#include "gpu/raster/shadow_tree.h"

#include <cstring>

#include "gpu/raster/occluders.h"

namespace airlight::gpu {

struct ShadowTree::Data {
  int nodes = 0, solids = 0;
  Point3 middle = Point3::Zero();
  std::vector<int> words;
};

ShadowTree::Data ShadowTree::data(const scene::Scene& scene) {
  Data data;
  if (!scene.geometry) return data;
  if (const Box box = scene.geometry->bounds(); !box.empty()) data.middle = box.center();
  const Occluders occluders = make_occluders(scene.surfaces, data.middle);
  data.nodes = int(occluders.nodes.size());
  data.solids = int(occluders.solids.size());
  data.words.resize(8 * occluders.nodes.size());
  static_assert(sizeof(OccluderNode) == 8 * sizeof(int));
  if (!data.words.empty()) std::memcpy(data.words.data(), occluders.nodes.data(), data.words.size() * sizeof(int));
  data.words.insert(data.words.end(), occluders.order.begin(), occluders.order.end());
  data.words.resize((data.words.size() + 3) / 4 * 4);
  return data;
}

ShadowTree::ShadowTree(Context& context, const scene::Scene& scene) : ShadowTree(context, data(scene)) {}

ShadowTree::ShadowTree(Context& context, const Data& data)
    : nodes_(data.nodes), solids_(data.solids), middle_(data.middle), tree_(context, "tree of surfaces", data.words) {}

void ShadowTree::bind(LinkedProgram& program) const {
  tree_.bind(14);
  program.set("tree_nodes", nodes_);
  program.set("solid_count", solids_);
  program.set_double("tree_middle", middle_);
}

}  // namespace airlight::gpu
