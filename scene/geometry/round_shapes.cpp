#include "scene/geometry/round_shapes.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"
#include "scene/geometry/sheet.h"

namespace airlight::scene {
namespace {

void require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(fmt::format("{} = {}, expected a finite number above 0", what, value));
}

void require_count(int count, int least, const char* what) {
  if (count < least) throw Error(fmt::format("{} = {}, expected at least {}", what, count, least));
}

// How far out the surface lies in direction u, relative to the sphere.
double stretch(const DisplacedSphere& s, const Vec3& u) {
  double r = 1;
  for (const auto& wave : s.waves) r += wave.amplitude * std::sin(wave.wave_vector.dot(u) + wave.phase);
  for (const auto& bump : s.bumps) {
    // By the half angle: exact near 0, where the arc cosine is not.
    const double angle = 2 * std::atan2((u - bump.direction).norm(), (u + bump.direction).norm());
    r += bump.height * std::exp(-(angle * angle) / (bump.width * bump.width));
  }
  return r;
}

// v turned as the unit vector `from` is turned into the unit vector `to` the shortest way; they are not opposite. Rodrigues'
// formula: Eigen's quaternion of two vectors would bring in a singular value decomposition.
Vec3 turned(const Vec3& from, const Vec3& to, const Vec3& v) {
  const Vec3 axis = from.cross(to);  // times the sine
  return from.dot(to) * v + axis.cross(v) + axis.dot(v) / (1 + from.dot(to)) * axis;
}

// The curve through the points at s in [0, 1]; outer control points are mirrored.
Point3 on_curve(const std::vector<Point3>& path, double s) {
  const int last = int(path.size()) - 1;
  const double x = s * last;
  const int i = std::min(int(x), last - 1);
  const double t = x - i;
  const Point3 &p1 = path[i], &p2 = path[i + 1];
  const Point3 p0 = i > 0 ? path[i - 1] : Point3(2 * p1 - p2), p3 = i + 2 <= last ? path[i + 2] : Point3(2 * p2 - p1);
  return 0.5 *
         (2 * p1 + t * (p2 - p0) + t * t * (2 * p0 - 5 * p1 + 4 * p2 - p3) + t * t * t * (3 * p1 - p0 - 3 * p2 + p3));
}

}  // namespace

TriangleMesh make_displaced_sphere(const DisplacedSphere& s) {
  for (int axis = 0; axis < 3; ++axis) require_positive(s.radii[axis], "radius of a sphere");
  require_count(s.around, 3, "vertices around a sphere");
  require_count(s.rings, 3, "rings of a sphere");
  TriangleMesh mesh;
  add_sheet(mesh, s.around, s.rings, true, false, [&](int i, int k) -> Point3 {
    const double phi = 2 * pi * i / s.around, theta = pi * k / (s.rings - 1);
    Vec3 u(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
    // All vertices of a pole lie in one place to the last bit: the surface is closed.
    if (k == 0) u = Vec3::UnitY();
    if (k == s.rings - 1) u = -Vec3::UnitY();
    const double r = stretch(s, u);
    if (!(r > 0) || !std::isfinite(r))
      throw Error(fmt::format("displaced sphere is {} of its radius at [{}, {}, {}], expected a share above 0", r, u[0],
                              u[1], u[2]));
    return s.center + r * s.radii.cwiseProduct(u);
  });
  return mesh;
}

TriangleMesh make_torus(const Torus& t) {
  require_positive(t.radius, "radius of a torus");
  require_positive(t.tube_radius, "tube radius of a torus");
  if (!(t.tube_radius < t.radius))
    throw Error(fmt::format("tube radius {} of a torus of radius {}, expected one below it", t.tube_radius, t.radius));
  require_count(t.around, 3, "vertices around a torus");
  require_count(t.across, 3, "vertices across a torus");
  const Vec3 e = t.axis.unitOrthogonal(), f = t.axis.cross(e);
  TriangleMesh mesh;
  add_sheet(mesh, t.around, t.across, true, true, [&](int i, int k) -> Point3 {
    const double phi = 2 * pi * i / t.around, psi = -2 * pi * k / t.across;
    const Vec3 out = std::cos(phi) * e + std::sin(phi) * f;
    return t.center + (t.radius + t.tube_radius * std::cos(psi)) * out + t.tube_radius * std::sin(psi) * t.axis;
  });
  return mesh;
}

TriangleMesh make_tube(const Tube& tube) {
  if (tube.path.size() < 2) throw Error(fmt::format("tube through {} points, expected at least 2", tube.path.size()));
  for (std::size_t i = 1; i < tube.path.size(); ++i)
    if (tube.path[i] == tube.path[i - 1]) throw Error("tube through a point twice running, expected points apart");
  require_positive(tube.radius, "radius of a tube");
  require_positive(tube.end_radius, "end radius of a tube");
  require_count(tube.along, 2, "rings of a tube");
  require_count(tube.around, 3, "vertices around a tube");
  // Frames that do not twist: each is the one before, turned with the tangent.
  std::vector<Point3> centers;
  std::vector<Vec3> tangents, sides;
  for (int k = 0; k < tube.along; ++k) {
    const double s = double(k) / (tube.along - 1), h = 1e-4;
    centers.push_back(on_curve(tube.path, s));
    tangents.push_back(
        (on_curve(tube.path, std::min(1.0, s + h)) - on_curve(tube.path, std::max(0.0, s - h))).normalized());
    if (!tangents[k].allFinite() || !(tangents[k].norm() > 0.5))
      throw Error("tube turns back on itself in a point, expected a smooth curve");
    const Vec3 side = k == 0 ? tangents[0].unitOrthogonal() : turned(tangents[k - 1], tangents[k], sides[k - 1]);
    sides.push_back((side - side.dot(tangents[k]) * tangents[k]).normalized());
  }
  TriangleMesh mesh;
  add_sheet(mesh, tube.around, tube.along, true, false, [&](int i, int k) -> Point3 {
    const double phi = -2 * pi * i / tube.around, s = double(k) / (tube.along - 1);
    const double radius = tube.radius + s * (tube.end_radius - tube.radius);
    return centers[k] + radius * (std::cos(phi) * sides[k] + std::sin(phi) * tangents[k].cross(sides[k]));
  });
  if (tube.caps) {
    add_cap(mesh, 0, tube.around, false);
    add_cap(mesh, tube.around * (tube.along - 1), tube.around, true);
  }
  return mesh;
}

TriangleMesh make_prism(const Prism& prism) {
  require_count(prism.sides, 3, "sides of a prism");
  require_positive(prism.radius, "radius of a prism");
  require_positive(prism.top_radius, "top radius of a prism");
  require_positive(prism.height, "height of a prism");
  TriangleMesh mesh;
  add_sheet(mesh, prism.sides, 2, true, false, [&](int i, int k) -> Point3 {
    const double phi = 2 * pi * i / prism.sides, r = k == 0 ? prism.radius : prism.top_radius;
    return prism.base + Vec3(r * std::cos(phi), k == 0 ? 0 : prism.height, r * std::sin(phi));
  });
  if (prism.caps) {
    add_cap(mesh, 0, prism.sides, false);
    add_cap(mesh, prism.sides, prism.sides, true);
  }
  return mesh;
}

}  // namespace airlight::scene
