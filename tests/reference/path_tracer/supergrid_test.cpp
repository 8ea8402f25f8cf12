#include "reference/path_tracer/supergrid.h"

#include <catch2/catch.hpp>
#include <random>

#include "reference/path_tracer/media.h"
#include "scene/math/random.h"
#include "scene/media/voxel_grid.h"
#include "tests/reference/path_tracer/scenes.h"

namespace supergrid_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

double linear_bound(const Box& box) { return 1 + box.hi[0] + 2 * box.hi[1] + 4 * box.hi[2]; }

Ray random_ray(int i) {
  const RandomBlock a = SampleRandom(2, 1, 0, i).block(0, Purpose::camera);
  const RandomBlock b = SampleRandom(2, 1, 0, i).block(1, Purpose::camera);
  Vec3 d(b.coarse(0) - 0.5, b.coarse(1) - 0.5, b.coarse(2) - 0.5);
  if (i % 5 == 0) d[i % 3] = 0;
  if (i % 7 == 0) d[(i + 1) % 3] = 0;
  if (d.norm() == 0) d = Vec3(0, 0, 1);
  return {Point3(4 * a.coarse(0) - 1.5, 4 * a.coarse(1) - 1.5, 4 * a.coarse(2) - 1.5), d.normalized()};
}

}  // namespace

TEST_CASE("a walk covers the ray once, in order, with a bound of every point", "[path_tracer]") {
  Supergrid grid = make_supergrid({{0, 0, 0}, {1, 1, 1}}, {5, 3, 4}, 1, linear_bound);
  grid.outside = 9;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = random_ray(i);
    for (const Interval t : {Interval{0, 5}, Interval{0.3, 0.9}, Interval{0, infinity}}) {
      double at = t.lo;
      bool bounded = true;
      walk(grid, ray, t, [&](double begin, double end, double majorant) {
        CHECK(begin == at);
        CHECK(end >= begin);
        at = end;
        for (const double s : {0.001, 0.5, 0.999}) {
          const Point3 x = ray.at(begin + s * (std::min(end, 10.0) - begin));
          const bool inside = (x.array() > 1e-12).all() && (x.array() < 1 - 1e-12).all();
          bounded = bounded && (!inside || majorant >= 1 + x[0] + 2 * x[1] + 4 * x[2] - 1e-6);
        }
        return false;
      });
      CHECK(at == t.hi);
      CHECK(bounded);
    }
  }
}

TEST_CASE("a ray in a face of the cells is bounded by one of its sides", "[path_tracer]") {
  const Supergrid grid = make_supergrid({{0, 0, 0}, {1, 1, 1}}, {4, 4, 4}, 1, linear_bound);
  double length = 0;
  walk(grid, {{-1, 0.5, 0.25}, {1, 0, 0}}, {0, 3}, [&](double begin, double end, double majorant) {
    if (majorant > 0) length += end - begin;
    return false;
  });
  CHECK(length == Approx(1));
}

TEST_CASE("majorants are rounded up", "[path_tracer]") {
  for (const double x : {0.1, 1.0, 1e-30, 3.14159265358979, 1e30}) {
    CHECK(double(round_up(x)) >= x);
    CHECK(double(round_up(x)) <= x * (1 + 1.2e-7));
  }
}

TEST_CASE("majorants of media bound them everywhere, also beyond the grid", "[path_tracer]") {
  scene::GaussianSum sum;
  sum.constant = 0.3;
  sum.gaussians = {{{0.2, 0.1, 0}, 0.5, 2}, {{1, 1, 1}, 0.3, 5}, {{-1, 0.5, 0}, 0.7, -0.2}};
  scene::Medium gaussians;
  gaussians.field = sum;
  scene::Medium sphere = gaussians;
  sphere.region = scene::Sphere{{0.5, 0.5, 0.5}, 1};
  auto voxels = std::make_shared<scene::VoxelGrid>();
  voxels->size = {9, 7, 5};
  voxels->voxel_size = 0.25;
  voxels->translation = {-0.5, -0.5, -0.5};
  voxels->rotation = (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  for (int i = 0; i < 9 * 7 * 5; ++i) voxels->values.push_back(float((7 * i) % 11) / 10);
  scene::Medium grid;
  grid.field = std::shared_ptr<const scene::VoxelGrid>(voxels);
  for (const scene::Medium& medium : {gaussians, sphere, grid}) {
    const Media media({medium}, Options{});
    int looked = 0;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = random_ray(i);
      const TrackedMedium& tracked = media.tracked()[0];
      walk(tracked.majorants, tracked.tracking_ray(ray), {0, 6}, [&](double begin, double end, double majorant) {
        for (const double s : {0.0, 0.3, 0.7, 1.0}) {
          const double density = scene::density(medium, ray.at(begin + s * (end - begin)));
          if (density > 0) ++looked;
          // 1e-14: how far rounding may put a point on a face to its other side, times the steepest density here.
          if (density > majorant * (1 + 1e-6) + 1e-14)
            FAIL("density " << density << " above its majorant " << majorant);
        }
        return false;
      });
    }
    CHECK(looked > 1000);
  }
}

TEST_CASE("the Gaussians that count in a cell give the density of all", "[path_tracer]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double cutoff : {infinity, 2.5})
    for (const double constant : {0.0, 1e-9, 0.1}) {
      scene::GaussianSum sum;
      sum.cutoff = cutoff;
      sum.constant = constant;
      for (int i = 0; i < 200; ++i) {
        const Point3 center{4 * uniform(random), uniform(random), 4 * uniform(random)};
        const double width = std::pow(10, -1.5 + uniform(random)), amplitude = std::pow(10, 4 * uniform(random) - 2);
        sum.gaussians.push_back({center, width, amplitude});
      }
      std::vector<scene::Medium> mediums(1);  // media hold pointers to them
      mediums[0].field = sum;
      const Media media(mediums, Options{});
      const TrackedMedium& tracked = media.tracked()[0];
      REQUIRE(tracked.of_cell.size() == tracked.majorants.majorants.size());
      std::size_t kept = 0;
      for (const scene::GaussianSum& here : tracked.of_cell) kept += here.gaussians.size();
      CHECK(kept < sum.gaussians.size() * tracked.of_cell.size() / 2);
      // Points in the cells, on their faces, and beyond them.
      const Box box = tracked.majorants.box();
      double worst = 0;
      for (int i = 0; i < 20000; ++i) {
        Point3 x = box.lo - 0.1 * box.size() +
                   1.2 * box.size().cwiseProduct(Vec3{uniform(random), uniform(random), uniform(random)});
        if (i % 4 == 0) x[0] = box.lo[0] + std::floor(17 * uniform(random)) * tracked.majorants.cell[0];
        const double all = scene::density(sum, x), here = tracked.density_at(x);
        if (all != here) worst = std::max(worst, std::abs(here - all) / all);
      }
      CHECK(worst < 2e-15);  // the sums add in another order
    }
  scene::Medium cancelling;
  scene::GaussianSum sum;
  for (int i = 0; i < 20; ++i) sum.gaussians.push_back({{0.1 * i, 0, 0}, 0.1, i == 7 ? -1.0 : 1.0});
  cancelling.field = sum;
  CHECK(Media({cancelling}, Options{}).tracked()[0].of_cell.empty());
}

}  // namespace supergrid_test
