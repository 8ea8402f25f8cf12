#include "gpu/shadow_planes/silhouette.h"

namespace airlight::gpu::shadow_planes {

// The layouts of edge_meshes.glsl, counts.comp and silhouette.comp.
struct Silhouettes::Arrays {
  std::vector<double> vertices;
  std::vector<int> triangles, numbers;
  std::vector<std::array<int, 4>> edges;
  std::vector<int> sides;
};

Silhouettes::Arrays Silhouettes::arrays(const airlight::shadow_planes::Occluders& occluders) {
  Arrays all;
  for (std::size_t m = 0; m < occluders.meshes().size(); ++m) {
    const airlight::shadow_planes::MeshEdges& mesh = *occluders.meshes()[m];
    const int vertex = int(all.vertices.size() / 3), triangle = int(all.triangles.size() / 3);
    const int side = int(all.sides.size());
    const std::size_t number = all.numbers.size();  // surfaces without triangles lie between the meshes
    all.numbers.resize(
        number + std::get<scene::TriangleMesh>(occluders.scene().surfaces[occluders.surface(m)].shape).triangles.size(),
        -1);
    for (const Point3& v : mesh.vertices()) all.vertices.insert(all.vertices.end(), v.data(), v.data() + 3);
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
      for (const int corner : mesh.triangles()[t]) all.triangles.push_back(vertex + corner);
      all.numbers[number + mesh.number(int(t))] = triangle + int(t);
    }
    for (const auto& edge : mesh.edges())
      all.edges.push_back({vertex + edge.a, vertex + edge.b, side + edge.first, edge.count});
    for (const auto& s : mesh.sides()) all.sides.push_back(2 * (triangle + s.triangle) + (s.forward ? 1 : 0));
  }
  return all;
}

Silhouettes::Silhouettes(Context& context, const airlight::shadow_planes::Occluders& occluders, int plane_rows)
    : Silhouettes(context, arrays(occluders), plane_rows) {}

Silhouettes::Silhouettes(Context& context, const Arrays& arrays, int plane_rows)
    : context_(context),
      mesh_edges_(int(arrays.edges.size())),
      plane_rows_(plane_rows),
      vertices_(context, "vertices of edges", arrays.vertices),
      triangles_(context, "triangles of edges", arrays.triangles),
      numbers_(context, "numbers of triangles", arrays.numbers),
      edges_(context, "edges of meshes", arrays.edges),
      sides_(context, "sides of edges", arrays.sides),
      program_(program(context, "silhouette", 64)) {}

void Silhouettes::find(const Point3& light, LightEdges& found) const {
  const Use use(context_);
  if (!found.edges) {
    found.edges = std::make_unique<Buffer>(context_, "silhouette", sizeof(EdgeData) * std::size_t(mesh_edges_),
                                           Contents::undefined);
    found.state = std::make_unique<Buffer>(context_, "state of a light", sizeof(LightStateData));
  }
  found.state->clear();
  bind_meshes();
  edges_.bind(at::mesh_edges);
  sides_.bind(at::mesh_sides);
  found.bind();
  program_.set("mesh_edge_count", mesh_edges_);
  program_.set("plane_rows", plane_rows_);
  program_.set_double("light", light);
  program_.dispatch(mesh_edges_);
}

void Silhouettes::bind_meshes() const {
  vertices_.bind(at::mesh_vertices);
  triangles_.bind(at::mesh_triangles);
  numbers_.bind(at::mesh_numbers);
}

}  // namespace airlight::gpu::shadow_planes
