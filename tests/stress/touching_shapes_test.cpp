// Camera and light exactly on every shape, in every renderer: what is seen is the limit from the side of the normal, or
// the scene is refused by name.
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "experiments/application/renderers.h"
#include "tests/gpu/device.h"
#include "tests/stress/shapes.h"
#include "tests/stress/stress.h"

namespace touching_shapes_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

std::string text_of(const Point3& x) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]); }

// Fogshop knows unbounded media alone.
std::shared_ptr<scene::Scene> scene_of(const std::string& surface, const Point3& camera, const Point3& target,
                                       const Point3& light, bool endless) {
  return std::make_shared<scene::Scene>(scene::parse_scene(
      "film = { width = 5, height = 5 }\n[camera]\nvertical_fov = 0.9\nposition = " + text_of(camera) + "\nlook_at = " +
          text_of(target) + "\n[[light]]\ntype = 'point'\nintensity = [3, 2, 1]\nposition = " + text_of(light) +
          "\n[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.3\nalbedo = 0.9\n" +
          (endless ? "" : "region = { type = 'sphere', center = [0, 0, 0], radius = 6 }\n") + "[[surface]]\n" +
          surface + "\nmaterial = { type = 'lambert', albedo = 0.5 }\n",
      "touching", "."));
}

struct Answer {
  scene::Film film;
  std::string refused;
};

Answer answer(const std::string& name, const std::shared_ptr<scene::Scene>& scene) {
  const scene::Renderer& renderer = experiments::find_renderer(name, "touching");
  Given given;
  if (name == "path_tracer") given = {{"samples", "256"}};
  if (name.starts_with("ray_marcher")) given = {{"steps", "64"}};
  const scene::Settings settings(renderer.settings(), given);
  if (const auto reasons = renderer.supports(*scene, settings); !reasons.empty()) return {{}, reasons.front()};
  try {
    return {renderer.prepare(scene, settings, {1, {}})->render(view_of(*scene), {1, {}}).film, ""};
  } catch (const Error& e) {
    return {{}, e.what()};
  }
}

// Equal but for `share` of the brightest pixel and noise; `stray` pixels may differ, at edges of what is seen and
// shadowed.
void check_alike(const Answer& at, const Answer& beside, double share, int stray) {
  CAPTURE(at.refused, beside.refused);
  REQUIRE(beside.refused == "");
  if (!at.refused.empty()) return;
  CHECK(all_finite(at.film));
  double most = 0, sum = 0, expected = 0;
  const std::vector<float>&a = at.film.layer("mean"), &b = beside.film.layer("mean");
  for (const float v : b) most = std::max(most, double(v));
  REQUIRE(most > 0);
  int far = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    double allowed = share * most;
    if (at.film.has("se")) allowed += 6 * std::hypot(at.film.layer("se")[i], beside.film.layer("se")[i]);
    far += !(std::abs(a[i] - b[i]) <= allowed);
    sum += a[i], expected += b[i];
  }
  CAPTURE(most, sum, expected);
  CHECK(far <= stray);
}

// Where a surface is touched, in the middle of a face, of an edge, at a vertex, and its normal or the mean of them.
struct Touched {
  std::string surface;
  Spot spot;
};

std::vector<Touched> touched() {
  std::vector<Touched> all = {
      {"type = 'sphere'\ncenter = [0, 0, 0]\nradius = 1", {{0.36, 0.8, 0.48}, {0.36, 0.8, 0.48}}},
      {"type = 'plane'\npoint = [0, 0.25, 0]\nnormal = [0, 1, 0]", {{0.1, 0.25, 0.2}, {0, 1, 0}}},
  };
  for (const char* shape : mesh_shapes) {
    const auto scene = scene_of(shape, {0, 9, 0}, {0, 0, 0.1}, {0, 8, 0}, false);
    const auto& mesh = std::get<scene::TriangleMesh>(scene->surfaces[0].shape);
    for (const Spot& spot : spots(mesh, mesh.triangles.size() / 2)) all.push_back({shape, spot});
  }
  return all;
}

const std::vector<std::string>& renderers() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names = {"deterministic", "ray_marcher", "path_tracer", "shadow_planes", "fogshop"};
    if (gpu::test::device()) names.insert(names.end(), {"ray_marcher_gpu", "shadow_planes_gpu", "fogshop_gpu"});
    return names;
  }();
  return all;
}

// On every spot of every shape, with every renderer; `side` is across the normal.
template <class Test>
void everywhere(const Test& test) {
  for (const Touched& t : touched())
    for (const std::string& name : renderers()) {
      CAPTURE(t.surface, name);
      test(t, name, Vec3(t.spot.out.unitOrthogonal()), name.starts_with("fogshop"));
    }
}

}  // namespace

// From the surface outwards, a quarter turn to the side: the horizon of the face runs past the picture.
TEST_CASE("stress: a camera on every shape", "[stress][touching][slow]") {
  everywhere([](const Touched& t, const std::string& name, const Vec3& side, bool endless) {
    const Point3 light = t.spot.at + 1.5 * t.spot.out + 0.4 * side;
    const auto from = [&](double off) {
      const Point3 eye = t.spot.at + off * t.spot.out;
      return answer(name, scene_of(t.surface, eye, eye + t.spot.out + 0.3 * side, light, endless));
    };
    check_alike(from(0), from(2e-5), 2e-3, 1);
  });
}

TEST_CASE("stress: a light on every shape, in every renderer", "[stress][touching][slow]") {
  everywhere([](const Touched& t, const std::string& name, const Vec3& side, bool endless) {
    const Point3 eye = t.spot.at + 2 * t.spot.out + 1.5 * side, target = t.spot.at + 0.6 * t.spot.out;
    const auto lit = [&](double off) {
      return answer(name, scene_of(t.surface, eye, target, t.spot.at + off * t.spot.out, endless));
    };
    check_alike(lit(0), lit(2e-5), 5e-3, 1);
  });
}

// Both on one spot: the light is moved off the surface, and stands beside the eye.
TEST_CASE("stress: camera and light on one spot of every shape", "[stress][touching][slow]") {
  everywhere([](const Touched& t, const std::string& name, const Vec3& side, bool endless) {
    const Point3 target = t.spot.at + t.spot.out + 0.3 * side;
    const Answer both = answer(name, scene_of(t.surface, t.spot.at, target, t.spot.at, endless));
    if (both.refused.empty()) CHECK(all_finite(both.film));
  });
}

}  // namespace touching_shapes_test
