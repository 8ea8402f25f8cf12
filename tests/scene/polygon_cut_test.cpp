#include "scene/geometry/polygon_cut.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

namespace polygon_cut_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

using Corners = std::vector<Point3>;

double twice_the_area(const Point3& a, const Point3& b, const Point3& c) { return Vec3(b - a).cross(Vec3(c - a))[2]; }

// Triangles of a polygon in the plane z = 0 that have no area of the other sign, and as much as the shoelace formula
// says: each point is covered as often as the polygon winds around it, so once within it and nowhere else.
// None of the triangles is without area, unless the polygon has corners that repeat: a corner on the edge of a triangle
// would leave a crack.
void check_cut(const Corners& corners, bool repeats = false) {
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += twice_the_area(corners[0], corners[i], corners[(i + 1) % corners.size()]);
  const auto triangles = cut_polygon(corners);
  REQUIRE(triangles);
  REQUIRE(triangles->size() == corners.size() - 2);
  double sum = 0, least = infinity;
  for (const auto& t : *triangles) {
    const double own = std::abs(twice_the_area(corners[t[0]], corners[t[1]], corners[t[2]]));
    sum += own;
    least = std::min(least, own);
  }
  CHECK((least > 0 || repeats));
  CHECK(sum == Approx(std::abs(area)).epsilon(1e-12));
}

// Wound either way, from each corner on, in the three coordinate planes.
void check_all(const Corners& corners, bool repeats = false) {
  for (Corners c : {corners, Corners(corners.rbegin(), corners.rend())})
    for (std::size_t first = 0; first < c.size(); ++first) {
      std::rotate(c.begin(), c.begin() + 1, c.end());
      CAPTURE(first, c.size());
      check_cut(c, repeats);
      Corners upright = c;
      for (Point3& p : upright) p = Point3(p[1], p[2], p[0]);
      CHECK(cut_polygon(upright) == cut_polygon(c));
    }
}

Corners of(std::initializer_list<std::pair<double, double>> list) {
  Corners corners;
  for (const auto& [x, y] : list) corners.emplace_back(x, y, 0);
  return corners;
}

}  // namespace

// Corners lie on the diagonals of others: 3 corners of the L on one, 4 of the T.
TEST_CASE("concave polygons are cut without a loss", "[geometry][polygon_cut]") {
  check_all(of({{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}}));
  check_all(of({{-1, 1}, {1, 1}, {1, .4}, {.3, .4}, {.3, -1}, {-.3, -1}, {-.3, .4}, {-1, .4}}));
  check_all(of({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}));                  // U
  check_all(of({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}));  // corners on edges
  check_all(of({{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {1, 2}}));
}

TEST_CASE("outlines of columns of whole heights", "[geometry][polygon_cut]") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 3000; ++trial) {
    const int columns = 1 + int(random() % 12);
    const int lowest = trial % 2 ? 4 : 0;
    Corners corners;
    const auto add = [&](int x, int y) {
      if (corners.empty() || corners.back() != Point3(x, y, 0)) corners.emplace_back(x, y, 0);
    };
    for (int x = 0; x < columns; ++x) {
      const int y = lowest ? -1 - int(random() % lowest) : 0;
      add(x, y);
      add(x + 1, y);
    }
    for (int x = columns; x-- > 0;) {
      const int y = 1 + int(random() % 4);
      add(x + 1, y);
      add(x, y);
    }
    if (trial % 3 == 0) std::reverse(corners.begin(), corners.end());
    CAPTURE(trial);
    check_cut(corners);
  }
}

TEST_CASE("holes at the end of an edge that runs to and fro", "[geometry][polygon_cut]") {
  check_all(of({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {2, 2}, {2, 8}, {8, 8}, {8, 2}, {2, 2}}), true);
  // Two holes, at one corner.
  check_all(of({{0, 0},
                {10, 0},
                {10, 10},
                {0, 10},
                {0, 0},
                {1, 4},
                {1, 6},
                {3, 6},
                {3, 4},
                {1, 4},
                {0, 0},
                {5, 1},
                {5, 3},
                {7, 3},
                {7, 1},
                {5, 1}}),
            true);
}

// A hole that touches a corner and hangs at another one: the triangle at the corner holds no corner of it, and yet two of
// its edges. Two holes that touch; a chain of holes, each at the last one's corner; triangles around one corner.
TEST_CASE("corners that several parts of a polygon share", "[geometry][polygon_cut]") {
  check_all(of({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {.9, .9}, {.9, 2.9}, {4, 4}, {2.9, .9}, {.9, .9}}), true);
  check_all(of({{0, 0},
                {9, 0},
                {9, 9},
                {0, 9},
                {0, 0},
                {2, 2},
                {2, 4},
                {4, 4},
                {4, 6},
                {6, 6},
                {6, 4},
                {4, 4},
                {4, 2},
                {2, 2}}),
            true);
  Corners chain = of({{0, 0}, {13, 0}, {13, 13}, {0, 13}, {0, 0}}), back;
  for (const double x : {1, 4, 7, 10}) {
    for (const Point3& p : {Point3(x, x, 0), Point3(x, x + 1, 0), Point3(x + 1, x + 1, 0)}) chain.push_back(p);
    back.insert(back.begin(), {Point3(x + 1, x + 1, 0), Point3(x + 1, x, 0), Point3(x, x, 0)});
  }
  chain.insert(chain.end(), back.begin() + 1, back.end());
  check_all(chain, true);
  for (int blades = 2; blades < 8; ++blades) {
    Corners wheel;
    for (int i = 0; i < blades; ++i) {
      const double angle = 2 * pi * i / blades;
      wheel.push_back(Point3::Zero());
      for (const auto& [radius, turn] : {std::pair{1.0, 0.0}, {0.6, 0.9 / blades}, {1.0, 2.0 / blades}})
        wheel.emplace_back(radius * std::cos(angle + turn), radius * std::sin(angle + turn), 0);
    }
    check_all(wheel, true);
  }
}

TEST_CASE("stars, spirals and combs", "[geometry][polygon_cut]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(0.05, 1);
  const auto at = [](double radius, double angle) {
    return Point3(radius * std::cos(angle), radius * std::sin(angle), 0);
  };
  for (int trial = 0; trial < 300; ++trial) {
    Corners corners;
    const int n = 5 + int(random() % 60);
    for (int i = 0; i < n; ++i) corners.push_back(at(length(random), 2 * pi * i / n));
    check_cut(corners);
  }
  Corners spiral, comb;
  const int n = 300;
  for (int i = 0; i < n; ++i) spiral.push_back(at(1 + 20.0 * i / n, 20.0 * i / n));
  for (int i = n; i-- > 0;) spiral.push_back(at(2 + 20.0 * i / n, 20.0 * i / n));
  check_cut(spiral);
  for (int i = 0; i < n; ++i) comb.emplace_back(i, i % 2 ? 9 : 0, 0);
  comb.emplace_back(n, -1, 0);
  comb.emplace_back(0, -1, 0);
  check_cut(comb);
}

TEST_CASE("polygons without area or such as cross themselves", "[geometry][polygon_cut]") {
  check_cut(of({{0, 0}, {1, 0}, {3, 0}, {2, 0}, {0.5, 0}}), true);
  check_cut(of({{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 1}, {0, 1}}), true);  // corners that repeat
  CHECK_FALSE(cut_polygon(of({{0, 0}, {2, 2}, {2, 0}, {0, 2}, {-1, 1}})));
  // Not flat, and crossing itself from each side: a surface all the same.
  CHECK(cut_polygon({{0, 0, 0}, {1, 1, 1}, {1, 0, -1}, {0, 1, 3}})->size() == 2);
}

// A corner that lies beside the diagonal by a last bit, on either side and on it: decided exactly.
TEST_CASE("a corner a rounding beside a diagonal", "[geometry][polygon_cut]") {
  for (const double x : {std::nextafter(0.1, 0), 0.1, std::nextafter(0.1, 1)})
    for (const double y : {std::nextafter(0.3, 0), 0.3, std::nextafter(0.3, 1)})
      check_all(of({{-0.2, -0.6}, {1, -0.6}, {0.4, 1.2}, {x, y}, {-0.8, 1.2}}), true);
}

}  // namespace polygon_cut_test
