#include "gpu/shadow_planes/silhouettes.h"

#include "gpu/program.h"

namespace airlight::gpu {

// The layouts of silhouette.comp.
struct Silhouettes::Arrays {
  std::vector<double> vertices;
  std::vector<int> triangles;
  std::vector<std::array<int, 4>> edges;
  std::vector<int> sides;
};

Silhouettes::Arrays Silhouettes::arrays(const shadow_planes::Occluders& occluders) {
  Arrays all;
  for (const shadow_planes::MeshEdges& mesh : occluders.meshes()) {
    const int vertex = int(all.vertices.size() / 3), triangle = int(all.triangles.size() / 3);
    const int side = int(all.sides.size());
    for (const Point3& v : mesh.vertices()) all.vertices.insert(all.vertices.end(), v.data(), v.data() + 3);
    for (const auto& t : mesh.triangles())
      for (const int corner : t) all.triangles.push_back(vertex + corner);
    for (const auto& edge : mesh.edges())
      all.edges.push_back({vertex + edge.a, vertex + edge.b, side + edge.first, edge.count});
    for (const auto& s : mesh.sides()) all.sides.push_back(2 * (triangle + s.triangle) + (s.forward ? 1 : 0));
  }
  return all;
}

Silhouettes::Silhouettes(Context& context, const shadow_planes::Occluders& occluders)
    : Silhouettes(context, arrays(occluders)) {}

Silhouettes::Silhouettes(Context& context, const Arrays& arrays)
    : context_(context),
      mesh_edges_(int(arrays.edges.size())),
      vertices_(context, "vertices of edges", arrays.vertices),
      triangles_(context, "triangles of edges", arrays.triangles),
      edges_(context, "edges of meshes", arrays.edges),
      sides_(context, "sides of edges", arrays.sides),
      count_(context, "number of edges", 4) {}

void Silhouettes::find(const Point3& light, LightEdges& found) {
  const Use use(context_);
  constexpr std::size_t edge_bytes = 96;
  if (!found.edges) found.edges = std::make_unique<Buffer>(context_, "silhouette", edge_bytes * mesh_edges_);
  found.count = 0;
  if (mesh_edges_ == 0) return;
  count_.upload(std::vector<int>{0});
  vertices_.bind(1);
  triangles_.bind(2);
  edges_.bind(3);
  sides_.bind(4);
  found.edges->bind(0);
  count_.bind(6);
  Program& p = context_.program("shadow_planes/silhouette.comp", {{"LOCAL_SIZE_X", "64"}});
  p.set("mesh_edge_count", mesh_edges_);
  p.set_double("light", light);
  p.dispatch(mesh_edges_);
  found.count = count_.download<int>().front();
}

}  // namespace airlight::gpu
