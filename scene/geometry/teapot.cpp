#include "scene/geometry/teapot.h"

#include <fmt/format.h>

#include <array>

#include "scene/base/error.h"
#include "scene/geometry/sheet.h"

namespace airlight::scene {
namespace {

using Patch = std::array<std::array<Point3, 4>, 4>;  // control points [row][column]

// Control points: M. Newell, as published in F. Crow, "The Origins of the Teapot", IEEE Computer Graphics and
// Applications 7(1), 1987. Written here as what they are made of: z up, the axis at x = y = 0, symmetric in y.

// Bodies of revolution: cubic profiles (r, z), each turned through four quarters.
struct Profile {
  std::array<std::array<double, 2>, 4> points;
};
constexpr std::array<Profile, 6> profiles = {{
    {{{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}}},  // rim
    {{{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}}},            // upper body
    {{{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}}},            // lower body
    {{{{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}}}},             // knob of the lid
    {{{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}}},              // lid
    {{{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0.0}, {0.0, 0.0}}}},           // bottom
}};

// Handle and spout: rows along them; each row is a half circle from the outer edge over the side to the inner one,
// (x, z) of its two ends and the half width y of the two points between. The other half is its mirror image.
struct Half {
  double x0, z0, x1, z1, width;
};
constexpr std::array<std::array<Half, 4>, 4> halves = {{
    {{{-1.6, 2.025, -1.5, 2.25, 0.3},
      {-2.3, 2.025, -2.5, 2.25, 0.3},
      {-2.7, 2.025, -3.0, 2.25, 0.3},
      {-2.7, 1.8, -3.0, 1.8, 0.3}}},
    {{{-2.7, 1.8, -3.0, 1.8, 0.3},
      {-2.7, 1.575, -3.0, 1.35, 0.3},
      {-2.5, 1.125, -2.65, 0.9375, 0.3},
      {-2.0, 0.9, -1.9, 0.6, 0.3}}},
    {{{1.7, 1.425, 1.7, 0.6, 0.66},
      {2.6, 1.425, 3.1, 0.825, 0.66},
      {2.3, 2.1, 2.4, 2.025, 0.25},
      {2.7, 2.4, 3.3, 2.4, 0.25}}},
    {{{2.7, 2.4, 3.3, 2.4, 0.25},
      {2.8, 2.475, 3.525, 2.49375, 0.25},
      {2.9, 2.475, 3.45, 2.5125, 0.15},
      {2.8, 2.4, 3.2, 2.4, 0.15}}},
}};

// Newell's approximation of a quarter of a circle: the inner control points lie 0.56 radii along the tangent. (The one
// of the knob's wide ring was published rounded, 0.45 for 0.448.)
Patch quarter(const Profile& profile, int turn) {
  constexpr double along = 0.56;
  Patch patch;
  for (int row = 0; row < 4; ++row) {
    const double r = profile.points[row][0], z = profile.points[row][1];
    const double k = r == 0.8 ? 0.45 : along * r;
    const std::array<std::array<double, 2>, 4> arc = {{{r, 0}, {r, k}, {k, r}, {0, r}}};
    for (int column = 0; column < 4; ++column) {
      double x = arc[column][0], y = arc[column][1];
      for (int t = 0; t < turn; ++t) {
        const double before = x;
        x = -y;
        y = before;
      }
      patch[row][column] = {x, y, z};
    }
  }
  return patch;
}

Patch half(const std::array<Half, 4>& rows, double side) {
  Patch patch;
  for (int row = 0; row < 4; ++row) {
    const Half& h = rows[row];
    patch[row] = {Point3(h.x0, 0, h.z0), Point3(h.x0, side * h.width, h.z0), Point3(h.x1, side * h.width, h.z1),
                  Point3(h.x1, 0, h.z1)};
  }
  return patch;
}

Point3 point_of(const Patch& patch, double u, double v) {
  const auto weights = [](double t) {
    const double s = 1 - t;
    return std::array{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  };
  const auto bu = weights(u), bv = weights(v);
  Point3 p = Point3::Zero();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) p += bv[row] * bu[column] * patch[row][column];
  return {p[0], p[2], -p[1]};  // y up
}

// `flipped` where the normal d/drow x d/dcolumn points inwards.
void add_patch(TriangleMesh& mesh, const Patch& patch, int size, bool flipped) {
  add_sheet(mesh, size, size, false, false, [&](int i, int k) {
    const double u = double(i) / (size - 1), v = double(k) / (size - 1);
    return point_of(patch, flipped ? 1 - u : u, v);
  });
}

}  // namespace

TriangleMesh make_teapot(int size) {
  if (size < 2 || size > 1024)
    throw Error(fmt::format("teapot with {} vertices on each side of a patch, expected 2 to 1024", size));
  TriangleMesh mesh;
  for (const Profile& profile : profiles)
    for (int turn = 0; turn < 4; ++turn) add_patch(mesh, quarter(profile, turn), size, false);
  for (const auto& rows : halves)
    for (const double side : {1.0, -1.0}) add_patch(mesh, half(rows, side), size, side < 0);
  return mesh;
}

}  // namespace airlight::scene
