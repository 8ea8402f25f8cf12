// The scenes after the paper's figures: numbers of triangles, and meshes that a stencil may count by.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "methods/shadow_planes/shadow_volumes.h"

namespace scenes_test {

using namespace airlight;
using namespace airlight::shadow_planes;

namespace {

std::shared_ptr<scene::Scene> load(const std::string& name, const std::map<std::string, std::string>& overrides = {}) {
  return std::make_shared<scene::Scene>(scene::load_scene(
      std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/shadow_planes/") + name + ".toml", overrides));
}

// Triangles of the surfaces whose name does not begin with `without`.
std::size_t triangles(const scene::Scene& scene, const std::string& without) {
  std::size_t count = 0;
  for (const auto& surface : scene.surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape))
      if (without.empty() || surface.name.rfind(without, 0) != 0) count += mesh->triangles.size();
  return count;
}

}  // namespace

TEST_CASE("shadow planes: triangles of the scenes after the paper's", "[shadow_planes][scenes]") {
  struct Row {
    const char* name;
    std::size_t triangles;  // the paper's where it counts them: 34,549; 14,785; 20,747; 107,514
    const char* without;
  };
  for (const Row& row : {Row{"fig7", 960, "floor"}, Row{"fig8a", 34'560, ""}, Row{"fig8b", 14'700, ""},
                         Row{"fig8c", 20'592, ""}, Row{"fig1", 107'514, ""}}) {
    CAPTURE(row.name);
    CHECK(triangles(*load(row.name), row.without) == row.triangles);
  }
}

TEST_CASE("shadow planes: occluders of the scenes are closed and outward", "[shadow_planes][scenes]") {
  for (const char* name :
       {"fig1", "fig7", "fig7_shade", "fig8a", "fig8b", "fig8c", "edges", "layers_elephant", "layers_knot1"}) {
    const auto scene = load(name);
    for (const scene::Surface& surface : scene->surfaces) {
      const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape);
      if (!mesh) continue;
      CAPTURE(name, surface.name);
      CHECK(mesh->removed_degenerate == 0);
      const MeshEdges edges(*mesh);
      int open = 0;
      for (const MeshEdges::Edge& e : edges.edges())
        if (e.count != 2 || edges.sides()[e.first].forward == edges.sides()[e.first + 1].forward) ++open;
      CHECK(open == 0);
      double volume = 0;
      for (const auto& t : mesh->triangles)
        volume += mesh->vertices[t[0]].dot(mesh->vertices[t[1]].cross(mesh->vertices[t[2]]));
      CHECK(volume > 0);
    }
    // Light and camera in the air, where stencil and count are the same.
    for (const scene::Light& light : scene->lights) {
      const ShadowVolumes shadows(std::make_shared<const Occluders>(scene), scene::ball(light)->center);
      CHECK(shadows.count(scene->camera.position) % 2 == 0);
    }
  }
}

TEST_CASE("shadow planes: the ball of Figure 7 has 32 edges in its silhouette", "[shadow_planes][scenes]") {
  const auto scene = load("fig7");
  REQUIRE(scene->surfaces[0].name == "ball");
  const Point3 light = scene::ball(scene->lights[0])->center;
  const auto edges = silhouette(MeshEdges(std::get<scene::TriangleMesh>(scene->surfaces[0].shape)), light);
  CHECK(edges.size() == 32);
  // All within the spot's cone: its shadow lies in the light.
  for (const SilhouetteEdge& edge : edges) CHECK(-edge.a.normalized()[1] > std::cos(0.43));
}

}  // namespace scenes_test
