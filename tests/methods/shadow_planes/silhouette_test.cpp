// Edges where more than two faces meet.
#include "methods/shadow_planes/silhouette.h"

#include <catch2/catch.hpp>

#include "methods/shadow_planes/shadow_volumes.h"
#include "tests/methods/shadow_planes/special_scenes.h"

namespace silhouette_test {

using namespace airlight;
using namespace airlight::shadow_planes;

namespace {

// A book without a cover: pages that share the edge from (0, 0, -1) to (0, 0, 1), their third corners in z = 0.
scene::TriangleMesh book(const std::vector<Point3>& corners) {
  scene::TriangleMesh mesh;
  mesh.vertices = {{0, 0, -1}, {0, 0, 1}};
  for (const Point3& corner : corners) {
    mesh.triangles.push_back({0, 1, int(mesh.vertices.size())});
    mesh.vertices.push_back(corner);
  }
  return mesh;
}

// How often the plane through the light and the spine is crossed, and in which direction: the multiplicity, less than 0
// where the edge runs from (0, 0, 1). 0: no such edge.
int spine(const scene::TriangleMesh& mesh, const Point3& light) {
  for (const SilhouetteEdge& edge : silhouette(MeshEdges(mesh), light))
    if (edge.a[0] == -light[0] && edge.b[0] == -light[0] && edge.a[1] == -light[1] && edge.b[1] == -light[1])
      return edge.a[2] < edge.b[2] ? edge.multiplicity : -edge.multiplicity;
  return 0;
}

ShadowVolumes shadows_of(const scene::TriangleMesh& mesh, const Point3& light) {
  auto scene = std::make_shared<scene::Scene>();
  scene->surfaces.push_back({"book", mesh, scene::Lambert{}});
  finish(*scene);
  return {std::make_shared<Occluders>(scene), light};
}

}  // namespace

// The light lies in y = 0, so y > 0 is behind the pages with a corner there. Crossing the spine's plane from below then
// changes the number of pages before a point by all of them, however many there are.
TEST_CASE("shadow planes: edges of many faces count every one", "[shadow_planes]") {
  const Point3 light(5, 0, 0);
  std::vector<Point3> above, mirrored;
  for (int pages = 1; pages <= 6; ++pages) {
    above.push_back({-1, double(pages), 0});
    mirrored.push_back({1, double(pages), 0});
    CAPTURE(pages);
    CHECK(std::abs(spine(book(above), light)) == pages);
    CHECK(spine(book(mirrored), -light) == -spine(book(above), light));  // the other way along the edge
    const ShadowVolumes shadows = shadows_of(book(above), light);
    CHECK(shadows.count({-3, 0.5, 0}) == pages);
    CHECK(shadows.count({-3, -0.5, 0}) == 0);
  }
  // Pages below take away from those above: six and two are four, six and six no edge at all.
  const int sign = spine(book(above), light) > 0 ? 1 : -1;
  std::vector<Point3> both = above;
  for (int pages = 1; pages <= 6; ++pages) {
    both.push_back({-1, -double(pages), 0});
    CAPTURE(pages);
    CHECK(spine(book(both), light) == sign * (6 - pages));
  }
  CHECK(shadows_of(book(both), light).count({-3, -0.5, 0}) == 6);
}

}  // namespace silhouette_test
