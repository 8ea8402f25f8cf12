// A light exactly on a surface: it lights the side that the normal faces, in every renderer (scene/light/light_on_surface.h).
#include <Eigen/Geometry>

#include "gpu/fogshop/fogshop.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "gpu/shadow_planes/shadow_planes.h"
#include "methods/fogshop/fogshop.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "reference/deterministic/renderer.h"
#include "reference/froxel_fog/froxel_fog.h"
#include "reference/half_resolution_march/half_resolution_march.h"
#include "reference/path_tracer/renderer.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "tests/gpu/device.h"
#include "tests/pictures.h"
#include "tests/stress/shapes.h"
#include "tests/stress/stress.h"

namespace light_on_surface_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

// A surface in a ball of fog of radius 6, with a light.
std::shared_ptr<scene::Scene> around(const std::string& surface, const std::optional<Point3>& light = {},
                                     double albedo = 0) {
  auto s = std::make_shared<scene::Scene>(scene::parse_scene(R"([camera]
position = [2.5, 3, 4]
look_at = [0, 0.3, 0]
[[medium]]
type = "homogeneous"
sigma_t = 0.3
albedo = 0.9
region = { type = "sphere", center = [0, 0, 0], radius = 6 }
[[surface]]
)" + surface,
                                                             "s.toml", "."));
  s->width = 12, s->height = 9;
  if (albedo > 0) s->media[0].region = scene::Unbounded{};  // what fogshop can do
  for (scene::Surface& each : s->surfaces) each.material = scene::Lambert{Rgb::Constant(albedo)};
  if (light) s->lights.push_back(scene::PointLight{*light, Rgb(3, 2, 1), 0});
  finish(*s);
  return s;
}

// Mean of a layer of the film.
double mean_of(const scene::Renderer& renderer, const std::shared_ptr<scene::Scene>& s, const char* layer,
               const Given& given = {}) {
  const scene::Film film = airlight::test::picture(renderer, s, given);
  double sum = 0;
  for (const float v : film.layer(layer)) sum += v;
  return sum / double(film.layer(layer).size());
}
double airlight_of(const scene::Renderer& renderer, const std::shared_ptr<scene::Scene>& s, const Given& given = {}) {
  return mean_of(renderer, s, renderer.name() == "path_tracer" ? "mean" : "airlight", given);
}

}  // namespace

// On faces, edges and vertices of every shape that is a mesh: the quadrature's picture is that of the light moved off
// by 2e-5 along the normal (the mean of the normals), where what changes is of the order of that distance over the size
// of the faces.
TEST_CASE("light on a surface: it stands before faces, edges and vertices of every shape", "[stress]") {
  const auto truth = deterministic::make_renderer();
  for (const char* shape : mesh_shapes) {
    const scene::TriangleMesh mesh = std::get<scene::TriangleMesh>(around(shape)->surfaces[0].shape);
    int number = 0;
    for (const Spot& spot : spots(mesh, mesh.triangles.size() / 2)) {
      CAPTURE(shape, number++, spot.at.transpose(), spot.out.transpose());
      const double on = airlight_of(*truth, around(shape, spot.at)),
                   off = airlight_of(*truth, around(shape, Point3(spot.at + 2e-5 * spot.out)));
      CHECK(on == Approx(off).epsilon(1e-3));
    }
  }
}

// Every renderer, on a ball, on a prism's cap and on a plane, against the quadrature of the light 2e-5 before the
// surface. On a ball the horizon sinks by sqrt(2 h), .005 rad, a few 1e-4 of the light. Behind the surface there is no
// light, or (the plane) half the fog to shine upon, and that unseen.
TEST_CASE("light on a surface: all renderers light the side of the normal", "[stress]") {
  struct Case {
    const char* surface;
    Spot spot;
  };
  const Case cases[] = {
      {"type = 'sphere'\ncenter = [0, 0, 0]\nradius = 1", {{0.36, 0.8, 0.48}, {0.36, 0.8, 0.48}}},
      {"type = 'prism'\nsides = 7\nradius = 1\nheight = 0.8", {{0.1, 0.8, 0.2}, {0, 1, 0}}},
      {"type = 'plane'\npoint = [0, 0.25, 0]\nnormal = [0, 1, 0]", {{0.1, 0.25, 0.2}, {0, 1, 0}}},
  };
  const auto truth = deterministic::make_renderer();
  for (const Case& c : cases) {
    const auto on = around(c.surface, c.spot.at), before = around(c.surface, Point3(c.spot.at + 2e-5 * c.spot.out)),
               behind = around(c.surface, Point3(c.spot.at - 2e-5 * c.spot.out));
    const double expected = airlight_of(*truth, before);
    CAPTURE(c.surface, expected);
    CHECK(airlight_of(*truth, behind) < 0.5 * expected);
    CHECK(airlight_of(*truth, on) == Approx(expected).epsilon(1e-3));
    // Steps across the shadow's edge: order 1, 1/256 of the ray.
    const Given steps{{"steps", "256"}};
    CHECK(airlight_of(ray_marcher::RayMarcher(), on, steps) == Approx(expected).epsilon(5e-3));
    CHECK(airlight_of(half_resolution_march::HalfResolutionMarch(), on, {{"divide", "1"}, {"steps", "256"}}) ==
          Approx(expected).epsilon(5e-3));
    CHECK(airlight_of(froxel_fog::FroxelFog(), on, {{"tile", "1"}, {"slices", "256"}}) ==
          Approx(expected).epsilon(5e-3));
    CHECK(airlight_of(shadow_planes::ShadowPlanes(), on) == Approx(expected).epsilon(1e-3));
    // 1024 samples on 108 pixels: the standard error of the mean is 2e-3 (four seeds); 5 of it.
    CHECK(airlight_of(path_tracer::PathTracer(), on, {{"samples", "1024"}, {"max_order", "1"}}) ==
          Approx(expected).epsilon(0.01));
    // Fogshop has no shadows in the air; what its surfaces are lit by has them.
    const auto grey = around(c.surface, c.spot.at, 0.5),
               grey_before = around(c.surface, c.spot.at + 2e-5 * c.spot.out, 0.5);
    const double lit = mean_of(*truth, grey_before, "surface");
    CHECK(mean_of(fogshop::Fogshop(), grey, "mean") ==
          Approx(mean_of(fogshop::Fogshop(), grey_before, "mean")).epsilon(1e-3));
    CHECK(mean_of(*truth, grey, "surface") == Approx(lit).epsilon(1e-2).margin(1e-6));
    if (!gpu::test::device()) continue;
    CHECK(mean_of(gpu::fogshop::Fogshop(), grey, "mean") ==
          Approx(mean_of(gpu::fogshop::Fogshop(), grey_before, "mean")).epsilon(1e-3));
    CHECK(airlight_of(gpu::ray_marcher::RayMarcher(), on, steps) == Approx(expected).epsilon(5e-3));
    CHECK(airlight_of(gpu::shadow_planes::ShadowPlanes(), on) == Approx(expected).epsilon(1e-3));
  }
}

// No place is in front of both: two balls that touch, a plane through a ball's lowest point from below.
TEST_CASE("light on a surface: between surfaces back to back it is refused", "[stress]") {
  auto s = around("type = 'sphere'\ncenter = [0, 0, 0]\nradius = 1");
  s->surfaces.push_back({"other", scene::Sphere{{0, 2, 0}, 1}, scene::Lambert{}});
  s->lights.push_back(scene::PointLight{{0, 1, 0}, Rgb::Ones(), 0});
  CHECK_THROWS_WITH(finish(*s), Catch::Contains("light 0: lies on 2 faces") && Catch::Contains("expected a light off"));
}

}  // namespace light_on_surface_test
