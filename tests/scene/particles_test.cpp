// Particles as a camera sees them, and where random ones lie.
#include "scene/flow/particles.h"

#include <cmath>

#include "scene/base/error.h"
#include "scene/camera_rays.h"
#include "scene/flow/random_points.h"
#include "scene/load/assets.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"

namespace particles_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

constexpr int width = 40, height = 30;

scene::Camera looking_down_z() {
  scene::Camera camera = scene::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  camera.vertical_fov = 0.8;
  return camera;
}

int covered(const scene::Backdrop& picture) {
  int count = 0;
  for (const float depth : picture.depth) count += depth < float(infinity);
  return count;
}

}  // namespace

TEST_CASE("a disc covers the pixels whose centres it covers, at its own depth", "[particles]") {
  const scene::Camera camera = looking_down_z();
  scene::Particles particles;
  particles.positions = {{0.31, -0.2, 1}};
  particles.radius = 0.4;
  particles.radiances = {Rgb(1, 2, 3)};
  const scene::Backdrop picture = draw(particles, camera, width, height);
  const scene::CameraRays rays(camera, width, height);
  int inside = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Ray ray = rays(x + 0.5, y + 0.5);
      const Point3 at = ray.at(-4 / ray.direction[2]);  // in the plane z = 1
      const bool covers = (at - particles.positions[0]).norm() <= 0.4;
      inside += covers;
      CHECK((picture.depth[y * width + x] == 4.0f) == covers);
      CHECK(picture.radiance[3 * (y * width + x) + 2] == (covers ? 3.0f : 0.0f));
    }
  CHECK(inside > 20);
  CHECK(covered(picture) == inside);
}

TEST_CASE("a particle below a pixel's size covers the pixel that it lies in", "[particles]") {
  scene::Particles particles;
  particles.radius = 1e-6;
  particles.radiances = {Rgb::Ones()};
  const scene::Camera camera = looking_down_z();
  const scene::CameraRays rays(camera, width, height);
  for (const auto shape : {scene::Particles::Shape::disc, scene::Particles::Shape::sheet}) {
    particles.shape = shape;
    for (int i = 0; i < 100; ++i) {
      const Vec3 share = scene::random_shares(3, i, 0);
      const double x = width * share[0], y = height * share[1], t = 0.1 + 1000 * share[2];
      particles.positions = {rays(x, y).at(t)};
      const scene::Backdrop picture = draw(particles, camera, width, height);
      CHECK(covered(picture) == 1);
      CHECK(picture.depth[int(y) * width + int(x)] < infinity);
    }
  }
  particles.positions = {{0, 0, 6}, {0, 0, 5}, {100, 0, 4}};  // behind, on the camera, beside the film
  CHECK(covered(draw(particles, camera, width, height)) == 0);
}

TEST_CASE("of particles that cover one pixel the nearest is seen, and sheets lie in their planes", "[particles]") {
  const scene::Camera camera = looking_down_z();
  scene::Particles particles;
  particles.radius = 0.5;
  particles.radiances = {Rgb(1, 0, 0), Rgb(0, 1, 0)};
  particles.positions = {{0, 0, 0}, {0, 0, 2}};
  const scene::Backdrop discs = draw(particles, camera, width, height);
  const std::size_t middle = std::size_t(height / 2) * width + width / 2;
  CHECK(discs.depth[middle] == 3.0f);
  CHECK(discs.radiance[3 * middle + 1] == 1.0f);
  std::swap(particles.positions[0], particles.positions[1]);
  CHECK(draw(particles, camera, width, height).radiance[3 * middle] == 1.0f);

  // All points of a sheet lie within half its diagonal, and it is seen from most sides.
  particles.shape = scene::Particles::Shape::sheet;
  particles.radius = 1;
  int seen = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    particles.seed = seed;
    particles.positions = {{0, 0, 0}};
    const scene::Backdrop sheet = draw(particles, camera, width, height);
    seen += covered(sheet);
    for (const float depth : sheet.depth)
      if (depth < float(infinity)) CHECK(std::abs(depth - 5) <= std::sqrt(2.0));
    particles.angle = 0.7;
    CHECK(draw(particles, camera, width, height).depth != sheet.depth);
    particles.angle = 0;
  }
  // The mean of |cos| over all attitudes is 1/2: of (2 m / pixel)^2.
  const double pixel = 2 * std::tan(0.4) * 5 / height;
  CHECK(seen / 20.0 == Approx(0.5 * 4 / (pixel * pixel)).epsilon(0.35));
}

TEST_CASE("random particles are those of their seed, and fill their region evenly", "[particles]") {
  const scene::Region ball = scene::Sphere{{1, 2, 3}, 2};
  const Box box = bounding_box(ball);
  const auto points = scene::random_points(ball, box, 4000, 7);
  CHECK(points == scene::random_points(ball, box, 4000, 7));
  CHECK(points != scene::random_points(ball, box, 4000, 8));
  const auto fewer = scene::random_points(ball, box, 100, 7);
  CHECK(std::equal(fewer.begin(), fewer.end(), points.begin()));
  Vec3 mean = Vec3::Zero();
  double square = 0;
  for (const Point3& x : points) {
    REQUIRE((x - Point3(1, 2, 3)).norm() <= 2);
    mean += (x - Point3(1, 2, 3)) / 4000;
    square += (x - Point3(1, 2, 3)).squaredNorm() / 4000;
  }
  CHECK(mean.norm() < 5 * 2 * std::sqrt(0.6 / 4000));       // standard deviation of the mean: sqrt(3/5) R / sqrt(n)
  CHECK(square == Approx(0.6 * 4).epsilon(5 * 0.44 / 63));  // of r^2: sqrt(12/175) R^2
  CHECK_THROWS_WITH(scene::random_points(scene::Sphere{{0, 0, 0}, 1e-3}, {Point3(-1, -1, -1), Point3(1, 1, 1)}, 1, 0),
                    Contains("1/10000"));
}

TEST_CASE("particles are read from the rows of their set, and refused in one line", "[particles][load]") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "p.0003.csv") << "set,x,y,z\n0,0,0,0\n1,0,0,1\n1,0.1,0,1\n";
  std::ofstream(folder.path() / "bad.csv") << "set,x,y,z\n0,0,zero,0\n";
  const std::string head = camera + "[[particles]]\ntype = 'disc'\nradius = 0.1\nradiance = [[1, 1, 1]]\n";
  const auto said = [&](const std::string& rest) { return message(head + rest, folder.path().string()); };
  CHECK(said("file = 'p.####.csv'\nframe = 3\nset = 1\n").empty());
  CHECK(said("count = 5\nregion = { type = 'sphere', center = [0, 0, 0], radius = 1 }\n").empty());
  CHECK_THAT(said("file = 'p.####.csv'\nframe = 4\n"), Contains("p.0004.csv"));
  CHECK_THAT(said("file = 'p.####.csv'\nframe = 3\nset = 2\n"), Contains("particles of set 2"));
  CHECK_THAT(said("file = 'bad.csv'\n"), Contains("bad.csv:2:5: y = zero"));
  CHECK_THAT(said("count = 5\nregion = { type = 'slab', lo = 0, hi = 1 }\n"), Contains("an end on all sides"));
  CHECK_THAT(said("count = 0\nregion = { type = 'sphere', center = [0, 0, 0], radius = 1 }\n"), Contains("count = 0"));
  CHECK_THAT(said("count = 5\n"), Contains("missing key 'region'"));
  CHECK_THAT(said(""), Contains("file, count"));
  CHECK_THAT(message(camera + "[[particles]]\ntype = 'cube'\n"), Contains("disc"));
}

}  // namespace particles_test
