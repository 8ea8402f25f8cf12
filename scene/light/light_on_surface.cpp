#include "scene/light/light_on_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

constexpr double least_slope = 0.05;

// The nearest point of a triangle, by the regions of its edges. Source: Ericson, Real-Time Collision Detection, 5.1.5.
Point3 nearest_on_triangle(const Point3& x, const Point3& a, const Point3& b, const Point3& c) {
  const auto on_segment = [&](const Point3& p, const Point3& q) -> Point3 {
    const Vec3 along = q - p;
    const double length2 = along.squaredNorm();
    return p + (length2 > 0 ? std::clamp((x - p).dot(along) / length2, 0.0, 1.0) : 0.0) * along;
  };
  const Vec3 normal = (b - a).cross(c - a);
  const auto within = [&](const Point3& p, const Point3& q) { return normal.dot((q - p).cross(x - p)) >= 0; };
  if (within(a, b) && within(b, c) && within(c, a)) return x - normal * (normal.dot(x - a) / normal.squaredNorm());
  Point3 nearest = on_segment(a, b);
  for (const Point3& p : {on_segment(b, c), on_segment(c, a)})
    if ((p - x).squaredNorm() < (nearest - x).squaredNorm()) nearest = p;
  return nearest;
}

// Normals of the faces that x lies on.
void add_normals(const TriangleMesh& mesh, const Point3& x, double tolerance, std::vector<Vec3>& normals) {
  for (const auto& triangle : mesh.triangles) {
    const Point3 &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
    if (((a.cwiseMin(b).cwiseMin(c) - x).array() > tolerance).any() ||
        ((x - a.cwiseMax(b).cwiseMax(c)).array() > tolerance).any())
      continue;
    const Vec3 normal = (b - a).cross(c - a);
    if (!(normal.squaredNorm() > 0)) continue;
    if ((nearest_on_triangle(x, a, b, c) - x).norm() <= tolerance) normals.push_back(normal.normalized());
  }
}

void add_normals(const Sphere& sphere, const Point3& x, double tolerance, std::vector<Vec3>& normals) {
  const Vec3 offset = x - sphere.center;
  if (std::abs(offset.norm() - sphere.radius) <= tolerance && offset.norm() > 0) normals.push_back(offset.normalized());
}

void add_normals(const Plane& plane, const Point3& x, double tolerance, std::vector<Vec3>& normals) {
  if (std::abs(plane.normal.dot(x - plane.point)) <= tolerance) normals.push_back(plane.normal);
}

// A unit direction that climbs away from all faces, the least of them as steeply as a few rounds find: each turns it
// towards the face that it leaves most slowly.
Vec3 away_from(const std::vector<Vec3>& normals, double& slope) {
  const auto slowest = [&](const Vec3& v) {
    return *std::min_element(normals.begin(), normals.end(),
                             [&](const Vec3& a, const Vec3& b) { return a.dot(v) < b.dot(v); });
  };
  Vec3 best = normals.front(), sum = Vec3::Zero();
  slope = slowest(best).dot(best);
  for (int round = 0; round < 1000; ++round) {
    sum += round < int(normals.size()) ? normals[round] : slowest(sum);
    const double norm = sum.norm();
    if (!(norm > 1e-9)) continue;
    const Vec3 v = sum / norm;
    if (const double now = slowest(v).dot(v); now > slope) slope = now, best = v;
  }
  return best;
}

// Away from the surfaces that x lies on, by `beside` of the size; zero where it lies on none. `what` begins the error.
Vec3 shift_off(const Scene& scene, const Point3& x, double tolerance, double size, const std::string& what) {
  std::vector<Vec3> normals;
  for (const Surface& surface : scene.surfaces)
    std::visit([&](const auto& shape) { add_normals(shape, x, tolerance * size, normals); }, surface.shape);
  if (normals.empty()) return Vec3::Zero();
  double slope;
  const Vec3 direction = away_from(normals, slope);
  if (!(slope >= least_slope))
    throw Error(
        fmt::format("{0}: lies on {1} faces of surfaces, and no place beside it is in front of all of them; "
                    "expected a {2} off the surfaces, or on faces with a common front",
                    what, normals.size(), what.substr(0, what.find(' '))));
  return beside * size / slope * direction;
}

double finite_size(const Scene& scene) {
  const Box box = scene.geometry->bounds();
  return box.empty() ? 0 : box.size().stableNorm();
}

}  // namespace

void move_camera_off_surfaces(Scene& scene) {
  if (scene.surfaces.empty() || scene.camera.kind != Camera::Kind::perspective) return;
  double size = finite_size(scene);
  if (!(size > 0)) {
    size = infinity;
    for (const Light& light : scene.lights)
      if (const auto own = ball(light); own && own->center != scene.camera.position)
        size = std::min(size, (own->center - scene.camera.position).stableNorm());
    if (size == infinity) size = std::max(scene.camera.position.stableNorm(), 1e-9);
  }
  scene.camera.position += shift_off(scene, scene.camera.position, eye_on_surface, size, "camera");
}

void move_lights_off_surfaces(Scene& scene) {
  if (scene.surfaces.empty()) return;
  const double finite = finite_size(scene);
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const auto own = ball(scene.lights[l]);
    if (!own) continue;
    // `there` is the size of what is seen: a lamp in front of a planet does not lie on the planet. Coordinates of the
    // whole scene are rounded to 1e-16 of its size.
    const double seen = (own->center - scene.camera.position).stableNorm();
    const double there = std::max(finite > 0 ? std::min(finite, seen) : seen, 1e-9 * finite);
    const Vec3 shift = shift_off(scene, own->center, on_surface, there, fmt::format("light {}", l));
    match(
        scene.lights[l], [&](PointLight& point) { point.position += shift; },
        [&](SpotLight& spot) { spot.position += shift; }, [](DirectionalLight&) {}, [](EnvironmentLight&) {});
  }
}

}  // namespace airlight::scene
