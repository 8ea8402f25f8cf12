// The tree of average depths against sums over all Gaussians: within its tolerance whatever fog and surfaces are.
#include "methods/fogshop/depth_tree.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>

#include "methods/fogshop/average_depths.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/geometry/shapes.h"
#include "scene/scene.h"
#include "tests/methods/fogshop/sky.h"
#include "tests/scene/geometry_scenes.h"

namespace depth_tree_test {

using namespace airlight;
using namespace airlight::fogshop;

namespace {

class Numbers {
 public:
  double operator()(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  Vec3 vector(double most) { return {(*this)(-most, most), (*this)(-most, most), (*this)(-most, most)}; }

 private:
  std::mt19937 engine_{7};
};

// Widths and amplitudes by logarithm between two bounds, centres in a cube of side 2.
std::vector<scene::Gaussian> banks(Numbers& number, int count, double narrowest, double widest) {
  std::vector<scene::Gaussian> result;
  for (int i = 0; i < count; ++i)
    result.push_back({number.vector(1), narrowest * std::pow(widest / narrowest, number(0, 1)), number(0.1, 1)});
  return result;
}

GaussianArrays scaled(std::vector<scene::Gaussian> gaussians, double scale, const Vec3& shift) {
  for (scene::Gaussian& g : gaussians) g = {scale * (g.center + shift), scale * g.width, g.amplitude / scale};
  return make_arrays(gaussians, Cull::depth, 1e-12).arrays;
}

Point3 on(const scene::Shape& shape, Numbers& number) {
  return scene::match(
      shape,
      [&](const scene::TriangleMesh& mesh) {
        const auto& corners = mesh.triangles[std::size_t(number(0, 1) * double(mesh.triangles.size() - 1e-9))];
        const double a = number(0, 1), b = number(0, 1 - a);
        const Point3& first = mesh.vertices[corners[0]];
        return Point3(first + a * (mesh.vertices[corners[1]] - first) + b * (mesh.vertices[corners[2]] - first));
      },
      [&](const scene::Sphere& ball) { return Point3(ball.center + ball.radius * number.vector(1).normalized()); },
      // From close by to far away.
      [&](const scene::Plane& plane) {
        const Vec3 aside = plane.normal.cross(number.vector(1)).normalized();
        return Point3(plane.point + std::pow(10.0, number(-2, 4)) * aside);
      });
}

struct Errors {
  double worst = 0, depth = 0;  // [-], the greatest depth
  double listed = 0;            // Gaussians of a cell, on average over points
};

Errors errors_of(const DepthTree& tree, const GaussianArrays& g, const std::vector<scene::Surface>& surfaces,
                 Numbers& number, int points) {
  Errors errors;
  for (const scene::Surface& surface : surfaces)
    for (int k = 0; k < points; ++k) {
      const Point3 x = on(surface.shape, number);
      const double truth = average_depth_of(g, x);
      errors.worst = std::max(errors.worst, std::abs(tree(x) - truth));
      errors.depth = std::max(errors.depth, truth);
    }
  for (const DepthCell& cell : tree.cells())
    errors.listed += double(cell.end - cell.begin) / double(tree.cells().size());
  return errors;
}

std::vector<scene::Surface> all_shapes(double scale, const Vec3& shift) {
  scene::TriangleMesh ring = scene::torus(24, 12), sheet;
  for (Point3& v : ring.vertices) v = scale * (v + shift);
  for (const Point3& v : {Point3(-1, 0.2, -1), Point3(1, 0.2, -1), Point3(0, 0.2, 1)})
    sheet.vertices.push_back(scale * (v + shift));
  sheet.triangles = {{0, 1, 2}};
  return {{"torus", ring, {}},
          {"sheet", sheet, {}},
          {"ball", scene::Sphere{scale * (Point3(0.4, 0.3, -0.2) + shift), 0.3 * scale}, {}},
          {"ground", scene::Plane{scale * (Point3(0, -0.4, 0) + shift), Vec3(0.1, 1, 0).normalized()}, {}}};
}

}  // namespace

TEST_CASE("what a cell's polynomial loses of a Gaussian is not above its bound", "[fogshop]") {
  Numbers number;
  double closest = 0;
  for (int k = 0; k < 20000; ++k) {
    const double half = std::pow(10.0, number(-1.2, 1.5)), off = k % 3 == 0 ? 0 : std::pow(10.0, number(-2, 1.2));
    // In halves of the cell's side: inside it, or beyond a face, an edge, a corner.
    Vec3 center = number.vector(1);
    for (int c = 0; c < k % 4; ++c) center[c] = (center[c] > 0 ? 1 : -1) * (1 + off);
    const auto depth = [&](const Vec3& place) {
      return 2 / std::sqrt(pi) * average_depth(half * (place - center).norm());
    };
    std::vector<double> values;
    for (const Vec3& place : cell_points()) values.push_back(depth(place));
    const CellPolynomial polynomial = fit_cell(values);
    const double distance = half * (center.cwiseAbs() - Vec3::Ones()).cwiseMax(0).norm();
    double worst = 0;
    for (int i = 0; i < 40; ++i) {
      Vec3 place = number.vector(1);
      for (int c = 0; c < i % 4; ++c) place[c] = center[c] > place[c] ? 1 : -1;
      worst = std::max(worst, std::abs(polynomial(place) - depth(place)));
    }
    const double bound = cell_error(2 * half, distance, 1);
    CAPTURE(half, center.transpose(), distance, worst, bound);
    REQUIRE(worst <= bound + 1e-15);
    if (bound < 0.1) closest = std::max(closest, worst / bound);
  }
  CHECK(closest > 0.5);
}

TEST_CASE("a cell's polynomial gives polynomials back", "[fogshop]") {
  const auto value = [](const Vec3& p) {
    return 1 + p.x() - 2 * p.y() * p.z() + p.x() * p.x() * p.y() * p.z() * p.z() - 0.5 * std::pow(p.y(), 5);
  };
  std::vector<double> values;
  for (const Vec3& place : cell_points()) values.push_back(value(place));
  const CellPolynomial polynomial = fit_cell(values);
  for (const Vec3& place : {Vec3(0.3, -0.7, 0.9), Vec3(-1, 1, 1), Vec3(0, 0, 0)})
    CHECK(polynomial(place) == Approx(value(place)).margin(1e-13));
}

TEST_CASE("the tree of average depths is as good as its tolerance", "[fogshop]") {
  struct Case {
    int count;
    double narrowest, widest;
  };
  for (const Case& c : {Case{1, 0.5, 0.5}, Case{40, 0.2, 0.6}, Case{60, 0.01, 0.5}, Case{1200, 0.05, 0.3}})
    for (const double scale : {1e-3, 1.0, 1e6})
      for (const double tolerance : {1e-2, 1e-4}) {
        if (c.count > 1000 && (scale != 1 || tolerance < 1e-3)) continue;
        Numbers number;
        const Vec3 shift = scale == 1 ? Vec3(0, 0, 0) : Vec3(30, -20, 10);
        const GaussianArrays g = scaled(banks(number, c.count, c.narrowest, c.widest), scale, shift);
        std::vector<scene::Surface> surfaces = all_shapes(scale, shift);
        for (const bool plane : {true, false}) {
          if (!plane) surfaces.pop_back();
          const DepthTree tree(g, surfaces, tolerance, {2, {}});
          const Errors errors = errors_of(tree, g, surfaces, number, 1500);
          CAPTURE(c.count, c.narrowest, scale, tolerance, plane, tree.cells().size(), errors.depth, errors.listed);
          CHECK(errors.worst < tolerance);
          CHECK(errors.listed < DepthTree::most_listed);
          if (std::getenv("AIRLIGHT_TEST_FIGURES"))
            fmt::print(
                "{} Gaussians from {} wide, scale {}, tolerance {}, {}: {} cells, {:.2f} listed, error {:.1e} of {:.2g}\n",
                c.count, c.narrowest, scale, tolerance, plane ? "plane" : "no plane", tree.cells().size(),
                errors.listed, errors.worst, errors.depth);
        }
      }
}

// Narrow Gaussians on the surface, a thousand times narrower than the others.
TEST_CASE("narrow Gaussians at a surface are exact in the tree", "[fogshop]") {
  Numbers number;
  std::vector<scene::Gaussian> gaussians = banks(number, 50, 0.3, 0.6);
  for (int i = 0; i < 30; ++i) gaussians.push_back({{number(-0.7, 0.7), 0.2, number(-0.9, 0)}, 3e-4, 2000});
  const GaussianArrays g = scaled(gaussians, 1, Vec3::Zero());
  const std::vector<scene::Surface> sheet = {all_shapes(1, Vec3::Zero())[1]};
  const DepthTree tree(g, sheet, 1e-4, {1, {}});
  double worst = 0, deepest = 0;
  for (int i = 0; i < 30; ++i)
    for (const double off : {0.0, 1e-4, 3e-4, 1e-3, 1e-2, 0.1}) {
      const Point3 x = gaussians[50 + i].center + off * Vec3(0.6, 0, 0.8);
      if (x.z() > 0.9 - 2 * std::abs(x.x())) continue;  // beyond the sheet
      worst = std::max(worst, std::abs(tree(x) - average_depth_of(g, x)));
      deepest = std::max(deepest, average_depth_of(g, x));
    }
  CHECK(deepest > 1);
  CHECK(worst < 1e-4);
  CHECK(tree.cells().size() < 5000);
}

TEST_CASE("a tree without a surface near the fog has no cells", "[fogshop]") {
  Numbers number;
  const GaussianArrays g = scaled(banks(number, 30, 0.2, 0.6), 1, Vec3::Zero());
  const std::vector<scene::Surface> far = {{"far", scene::Sphere{{1e5, 0, 0}, 1}, {}}};
  for (const auto& surfaces : {std::vector<scene::Surface>{}, far}) {
    const DepthTree tree(g, surfaces, 1e-4, {1, {}});
    CHECK(tree.side() == 0);
    CHECK(tree.cells().size() == 1);
    CHECK(tree({1e5, 1, 0}) == Approx(average_depth_of(g, {1e5, 1, 0})).epsilon(1e-3));
  }
}

}  // namespace depth_tree_test
