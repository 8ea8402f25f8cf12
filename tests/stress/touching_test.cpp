// Lights and cameras on, inside and touching every shape.
//
// Where a medium begins nothing jumps: a picture with the light or the camera exactly on its boundary is the limit of
// those beside it. A light exactly on a surface lights the side that the normal faces: the limit from there.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/renderers.h"
#include "scene/base/error.h"
#include "tests/gpu/device.h"
#include "tests/stress/stress.h"

namespace touching_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

struct Shape {
  std::string name, table;
  Point3 on;    // on its boundary
  Vec3 normal;  // outwards there
};

std::string point(const Point3& x) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]); }

// A picture, or what the renderer says against the scene.
struct Answer {
  scene::Film film;
  std::string refused;
};

std::string lamp(const Point3& at) { return "type = 'point'\nintensity = 3\nposition = " + point(at); }

Answer answer(const std::string& name, const Point3& camera, const std::string& light, const std::string& table) {
  // The camera looks past the middle: no ray along an axis or a face.
  const std::string text = "film = { width = 3, height = 3 }\n[camera]\nposition = " + point(camera) +
                           "\nlook_at = [0.11, 0.07, -0.13]\n[[light]]\n" + light + "\n" + table + "\n";
  const auto scene = std::make_shared<const scene::Scene>(scene::parse_scene(text, "touching", "."));
  const auto& renderer = experiments::find_renderer(name, "touching");
  const scene::Settings settings(renderer.settings(), name == "path_tracer"             ? Given{{"samples", "256"}}
                                                      : name.starts_with("compensated") ? Given{{"cells", "8"}}
                                                                                        : Given{});
  if (const auto reasons = renderer.supports(*scene, settings); !reasons.empty()) return {{}, reasons.front()};
  try {
    return {renderer.prepare(scene, settings, {1, {}})->render(view_of(*scene), {1, {}}).film, ""};
  } catch (const Error& e) {
    return {{}, e.what()};
  }
}
Answer answer(const std::string& name, const Point3& camera, const Point3& light, const std::string& table) {
  return answer(name, camera, lamp(light), table);
}

// The light's neighbourhood is bright and sampled badly by steps: what lies 1e-7 m aside moves a pixel by 1e-4 at most.
void check_limit(const std::string& renderer, const Answer& at, const Answer& beside) {
  if (!at.refused.empty()) return;
  CHECK(all_finite(at.film));
  REQUIRE(beside.refused == "");
  double most = 0;
  for (const float v : beside.film.layer("mean")) most = std::max(most, double(v));
  CHECK(most > 0);
  for (std::size_t i = 0; i < at.film.layer("mean").size(); ++i) {
    double allowed = (renderer == "ray_marcher" ? 1e-2 : 1e-4) * most;
    if (renderer == "path_tracer") allowed += 6 * std::hypot(at.film.layer("se")[i], beside.film.layer("se")[i]);
    CAPTURE(i, at.film.layer("mean")[i], beside.film.layer("mean")[i]);
    CHECK(std::abs(at.film.layer("mean")[i] - beside.film.layer("mean")[i]) <= allowed);
  }
}

const std::vector<std::string> on_processor = {"deterministic", "ray_marcher", "path_tracer", "fogshop",
                                               "shadow_planes"};
const Point3 far_light(2, 2.5, 1.5), far_camera(0.3, 0.5, 4);

}  // namespace

TEST_CASE("stress: light and camera on and inside media", "[stress][touching]") {
  const std::string homogeneous = "[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.8\nalbedo = 0.9\nregion = ";
  std::string values;
  for (int i = 0; i < 27; ++i) values += "1, ";
  const std::string grid =
      "[[medium]]\ntype = 'grid'\nsize = [3, 3, 3]\nvoxel_size = 0.5\norigin = [-0.5, -0.5, -0.5]\n"
      "values = [" +
      values + "]\nclamp_border = ";
  const Vec3 up = Vec3::UnitY();
  for (const Shape& s : std::vector<Shape>{
           {"sphere", homogeneous + "{ type = 'sphere', center = [0, 0, 0], radius = 1 }", {0, 1, 0}, up},
           {"box", homogeneous + "{ type = 'box', lo = [-1, -1, -1], hi = [1, 1, 1] }", {0.3, 1, 0.2}, up},
           {"corner of a box",
            homogeneous + "{ type = 'box', lo = [-1, -1, -1], hi = [1, 1, 1] }",
            {1, 1, 1},
            Vec3(1, 1, 1).normalized()},
           {"slab", homogeneous + "{ type = 'slab', lo = -1, hi = 1 }", {0.3, 1, 0.2}, up},
           {"grid", grid + "false", {0.2, 1, 0.1}, up},
           {"clamped grid", grid + "true", {0.2, 0.75, 0.1}, up},
           {"plane of voxels", grid + "true", {0.2, 0.5, 0.1}, up}}) {
    for (const std::string& renderer : on_processor) {
      CAPTURE(s.name, renderer);
      for (const double side : {1e-7, -1e-7}) {
        CAPTURE(side);
        const Point3 beside = s.on + side * s.normal;
        check_limit(renderer, answer(renderer, far_camera, s.on, s.table),
                    answer(renderer, far_camera, beside, s.table));
        check_limit(renderer, answer(renderer, s.on, far_light, s.table), answer(renderer, beside, far_light, s.table));
      }
      // Well inside, both.
      const Answer inside = answer(renderer, Point3(0.2, 0.3, 0.4), Point3(-0.3, 0.2, 0.1), s.table),
                   truth = answer("deterministic", Point3(0.2, 0.3, 0.4), Point3(-0.3, 0.2, 0.1), s.table);
      if (inside.refused.empty() && renderer != "path_tracer") check_limit("ray_marcher", inside, truth);
    }
    // Renderers that do not support lamps are tested under the sky.
    const std::string sky = "type = 'environment'\nradiance = 2";
    std::vector<std::string> under_the_sky = {"compensated_ray_marching"};
    if (gpu::test::device()) under_the_sky.push_back("compensated_ray_marching_gpu");
    for (const std::string& renderer : under_the_sky)
      for (const double side : {1e-7, -1e-7}) {
        CAPTURE(s.name, renderer, side);
        const Answer at = answer(renderer, s.on, sky, s.table);
        CHECK(at.refused.empty() == (s.name != "slab" && (renderer == under_the_sky[0] || s.table.starts_with(grid))));
        check_limit(renderer, at, answer(renderer, s.on + side * s.normal, sky, s.table));
      }
  }
}

TEST_CASE("stress: a light on a surface lights the side that its normal faces", "[stress][touching]") {
  const std::string fog =
      "[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.3\nregion = { type = 'sphere', center = [0, 0, 0], radius = 3 }\n";
  const Vec3 up = Vec3::UnitY();
  for (const Shape& s : std::vector<Shape>{
           {"ball", "[[surface]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 0.5\n", {0, 0.5, 0}, up},
           {"box", "[[surface]]\ntype = 'box'\nlo = [-0.5, -0.5, -0.5]\nhi = [0.5, 0.5, 0.5]\n", {0.1, 0.5, 0.2}, up},
           {"plane", "[[surface]]\ntype = 'plane'\npoint = [0, -0.5, 0]\n", {0.1, -0.5, 0.2}, up},
           {"prism",
            "[[surface]]\ntype = 'prism'\nbase = [0, -0.5, 0]\nsides = 12\nradius = 0.5\nheight = 1\n",
            {0.1, 0.5, 0.15},
            up},
           {"torus",
            "[[surface]]\ntype = 'torus'\nradius = 0.5\ntube_radius = 0.25\nsize = [32, 32]\n",
            {0.5, 0.25, 0},
            up}}) {
    for (const std::string& renderer : on_processor) {
      CAPTURE(s.name, renderer);
      const Answer at = answer(renderer, far_camera, s.on, fog + s.table),
                   above = answer(renderer, far_camera, s.on + 1e-6 * s.normal, fog + s.table);
      check_limit(renderer, at, above);
    }
  }
}

}  // namespace touching_test
