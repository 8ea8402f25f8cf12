// Stress cases 15 to 17 and 20: rays within faces, scenes of all sizes and far away, triangles that are none.
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/shapes.h"
#include "scene/media/voxel_grid.h"
#include "tests/stress/stress.h"

namespace place_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

// A cloud, a box of fog and a cube, under a lamp and a sun, scaled and moved.
struct Place {
  double scale = 1;
  Vec3 offset = Vec3::Zero();
  Point3 at(double x, double y, double z) const { return scale * Point3(x, y, z) + offset; }
  std::shared_ptr<scene::Scene> scene() const {
    scene::GaussianSum sum;
    sum.gaussians = {{at(0, 0.2, 0), 0.5 * scale, 1}, {at(0.5, 0.3, 0.1), 0.3 * scale, 2}};
    scene::VoxelGrid grid;
    grid.size = {4, 4, 4};
    grid.voxel_size = 0.4 * scale;
    grid.translation = at(-0.6, -0.5, -0.4);
    for (int i = 0; i < 64; ++i) grid.values.push_back(float((5 * i) % 7) / 7);
    return scene_of(
        {of_field(sum, 1 / scale, 0.9), of_grid(grid, 1 / scale, 0.7),
         medium(Box{at(-1, -1, -1), at(1, 1, 1)}, 0.2 / scale, 0.5)},
        {scene::PointLight{at(0.7, 0.9, 0.6), Rgb::Constant(3 * scale * scale)},
         scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb::Ones()}},
        {{"cube", scene::make_box({at(-0.3, -0.9, -0.3), at(0.3, -0.4, 0.3)}), scene::Lambert{Rgb::Constant(0.6)}}});
  }
  scene::View view(int side) const {
    scene::View v = view_from(at(0.2, 0.4, 3), at(0, 0, 0), side, 0.8);
    return v;
  }
};

// Every pixel of two pictures within `relative` of the brightest.
void check_same(const scene::Film& a, const scene::Film& b, const std::string& layer, double relative) {
  double greatest = 0, difference = 0;
  for (std::size_t i = 0; i < a.layer(layer).size(); ++i) {
    greatest = std::max(greatest, double(std::abs(a.layer(layer)[i])));
    difference = std::max(difference, double(std::abs(a.layer(layer)[i] - b.layer(layer)[i])));
  }
  CAPTURE(layer, greatest, difference);
  CHECK(greatest > 0);
  CHECK(difference <= relative * greatest);
}

// The means of two noisy pictures agree.
void check_means(const scene::Film& a, const scene::Film& b, double resolution) {
  double sum[2] = {0, 0}, square = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      sum[0] += a.get("mean", x, y)[0];
      sum[1] += b.get("mean", x, y)[0];
      square += std::pow(a.get("se", x, y)[0], 2) + std::pow(b.get("se", x, y)[0], 2);
    }
  check_equal(sum[0], sum[1], std::sqrt(square), resolution);
}

}  // namespace

TEST_CASE("stress 15: camera on the boundary face, ray in the face plane", "[stress]") {
  const std::vector<scene::Light> lights = {scene::PointLight{{0.5, 1.8, 0.4}}, scene::DirectionalLight{}};
  scene::VoxelGrid grid;
  grid.size = {5, 5, 5};
  grid.voxel_size = 0.25;
  grid.clamp_border = true;  // its support has a face with a jump
  grid.translation = Vec3::Constant(0.125);
  grid.values.assign(125, 1.0f);
  int index = 150;
  // The face y = 1 of a box, y = 1.25 of a grid, and an inner face between voxels (y = 0.625).
  for (const auto& [m, y] : {std::pair{medium(Box{{0, 0, 0}, {1, 1, 1}}, 2, 0.9), 1.0},
                             std::pair{of_grid(grid, 2, 0.9), 1.25}, std::pair{of_grid(grid, 2, 0.9), 0.625}}) {
    const auto scene = scene_of({m}, lights);
    const Ray in_plane = ray_of({0, y, 0}, {1, 0, 0.8});
    Ray within = in_plane;
    within.origin[1] = std::nextafter(y, 0);
    const auto a = deterministic::airlight(*scene, in_plane, infinity);
    const auto b = deterministic::airlight(*scene, within, infinity);
    CHECK((a.converged && b.converged));
    CHECK(b.radiance[0] > 0);
    // Two integrals good to 1e-10.
    CHECK(a.radiance[0] == Approx(b.radiance[0]).epsilon(2e-10));
    CHECK(scene::optical_depth(scene->media, in_plane, {0, infinity})[0] ==
          Approx(scene::optical_depth(scene->media, within, {0, infinity})[0]).epsilon(1e-14));
    const auto first = radiance(World(scene, Options{}), in_plane, 1 << 13, {}, ++index);
    const auto second = radiance(World(scene, Options{}), within, 1 << 13, {}, ++index);
    check_equal(first.total.mean[0], second.total.mean[0], std::hypot(first.total.error[0], second.total.error[0]),
                0.05);
    check_equal(a.radiance[0], first.orders[1], 0.05);
    CHECK(first.counters.violations == 0);
  }
}

TEST_CASE("stress 16: a scene scaled by 1e-4, and by a power of two", "[stress]") {
  const Place one;
  for (const char* const name : renderers) {
    const Given given = std::string(name) == "path_tracer" ? Given{{"samples", "256"}} : Given{};
    const scene::Film expected = picture(name, one.scene(), one.view(7), given);
    CAPTURE(name);
    const Place power{0x1p-13}, tenth{1e-4};
    const scene::Film bits = picture(name, power.scene(), power.view(7), given);
    for (const auto& [layer, values] : expected.layers) {
      CAPTURE(layer);
      // The quadrature's estimate of its own rounding is no part of the picture: small in both, that is all.
      if (layer != "error") CHECK(bits.layer(layer) == values);
    }
    const scene::Film scaled = picture(name, tenth.scene(), tenth.view(7), given);
    if (std::string(name) == "path_tracer") {
      check_means(expected, scaled, 0.02);
    } else {
      // Coordinates are rounded to 1e-16 of the scene; the ray marcher computes in float, some hundred operations.
      check_same(expected, scaled, "airlight", std::string(name) == "deterministic" ? 2e-7 : 2e-5);
      check_same(expected, scaled, "surface", std::string(name) == "deterministic" ? 2e-7 : 2e-5);
    }
  }
}

TEST_CASE("stress 17: a scene scaled by 1e6, and one moved by 1e6", "[stress]") {
  const Place one, large{1e6}, far{1, Vec3(1e6, -1e6, 1e6)};
  for (const Place& other : {large, far}) {
    CAPTURE(other.scale);
    for (const char* const name : biased_renderers) {
      CAPTURE(name);
      const scene::Film a = picture(name, one.scene(), one.view(7)), b = picture(name, other.scene(), other.view(7));
      // Far away positions are rounded to 1.2e-10 m, of lengths of 0.1 m and more: 1e-8 with the gradients of this
      // scene. Silhouettes lie between pixel centres.
      const double tolerance = std::string(name) == "deterministic" ? 2e-7 : 5e-5;
      check_same(a, b, "airlight", tolerance);
      check_same(a, b, "surface", tolerance);
      check_same(a, b, "transmittance", tolerance);
    }
    const Given given{{"samples", "256"}};
    check_means(picture("path_tracer", one.scene(), one.view(7), given),
                picture("path_tracer", other.scene(), other.view(7), {{"samples", "256"}, {"seed", "2"}}), 0.02);
  }
}

// Triangles without area are removed at load; duplicates are hit once; a sliver does not hurt.
TEST_CASE("stress 20: zero-area, duplicate and sliver triangles", "[stress]") {
  const scene::TriangleMesh clean = scene::make_box({{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}});
  scene::TriangleMesh dirty = clean;
  const int first = int(dirty.vertices.size());
  for (const Point3& x : {Point3(0, 0.5, 0), Point3(0.3, 0.5, 0), Point3(0.3, 0.5 + 1e-12, 0), Point3(0.15, 0.5, 0)})
    dirty.vertices.push_back(x);
  dirty.triangles.push_back({first, first, first + 1});      // a line
  dirty.triangles.push_back({first, first + 3, first + 1});  // three on a line
  dirty.triangles.push_back(dirty.triangles[4]);             // twice
  dirty.triangles.push_back({first, first + 1, first + 2});  // 1e-12 high, standing on the top face
  scene::remove_degenerate(dirty);
  CHECK(dirty.removed_degenerate == 2);
  const auto with = [](const scene::TriangleMesh& mesh) {
    return scene_of({medium(scene::Sphere{{0, 0, 0}, 2}, 0.4, 0.9)},
                    {scene::PointLight{{1, 1.5, 0.5}, Rgb::Constant(5)}},
                    {{"box", mesh, scene::Lambert{Rgb::Constant(0.5)}}});
  };
  const auto view = view_from({1.2, 1.4, 3}, {0, 0, 0}, 15, 0.6);
  for (const char* const name : renderers) {
    const Given given = std::string(name) == "path_tracer" ? Given{{"samples", "64"}} : Given{};
    const scene::Film a = picture(name, with(clean), view, given), b = picture(name, with(dirty), view, given);
    CAPTURE(name);
    CHECK(all_finite(b));
    CHECK(a.layer("mean") == b.layer("mean"));
  }
}

}  // namespace place_test
