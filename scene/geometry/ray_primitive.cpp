#include "scene/geometry/ray_primitive.h"

namespace airlight::scene {
namespace {

struct Sheared {
  double x, y, z;
};

Sheared shear(const ShearedRay& ray, const Point3& p) {
  const Vec3 v = p - ray.origin;
  return {v[ray.kx] - ray.sx * v[ray.kz], v[ray.ky] - ray.sy * v[ray.kz], ray.sz * v[ray.kz]};
}

// Twice the area of (0, p, q), and its sign; on a tie the sign after moving the origin by (e, e^2), e -> 0.
struct EdgeFunction {
  double value;
  int sign;
};

int sign_of(double v) { return (v > 0) - (v < 0); }

EdgeFunction edge(const Sheared& p, const Sheared& q) {
  const double value = difference_of_products(p.x, q.y, p.y, q.x);
  if (value != 0) return {value, sign_of(value)};
  return {0, p.y != q.y ? sign_of(p.y - q.y) : sign_of(q.x - p.x)};
}

}  // namespace

ShearedRay::ShearedRay(const Ray& ray) : origin(ray.origin) {
  const Vec3& d = ray.direction;
  d.cwiseAbs().maxCoeff(&kz);
  kx = (kz + 1) % 3;
  ky = (kz + 2) % 3;
  if (d[kz] < 0) std::swap(kx, ky);
  sx = d[kx] / d[kz];
  sy = d[ky] / d[kz];
  sz = 1 / d[kz];
}

int cross_triangle(const ShearedRay& ray, const Point3& a, const Point3& b, const Point3& c, Crossing& crossing) {
  const Sheared p = shear(ray, a), q = shear(ray, b), r = shear(ray, c);
  const EdgeFunction u = edge(q, r), v = edge(r, p);
  if (u.sign == 0 || u.sign != v.sign) return 0;
  const EdgeFunction w = edge(p, q);
  if (u.sign != w.sign) return 0;
  const double det = u.value + v.value + w.value;  // all of one sign
  if (det == 0) return 0;

  // A convex combination of the vertices' depths: bounded however the ray grazes, and its sign is right for an origin
  // that offset_origin moved off the triangle, since depths and shear err by a few ulp of the coordinates only.
  const double wb = v.value / det, wc = w.value / det;
  const double t = p.z + wb * (q.z - p.z) + wc * (r.z - p.z);
  if (!(t > 0)) return 0;
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 normal = accurate_cross(ab, ac).normalized();
  const bool outward = u.sign < 0;  // seen from the origin, the triangle is counter-clockwise
  crossing.t = t;
  crossing.position = a + wb * ab + wc * ac;
  crossing.normal = outward ? normal : Vec3(-normal);
  crossing.outward = outward;
  return 1;
}

int cross_sphere(const Ray& ray, const Sphere& sphere, std::array<Crossing, 2>& crossings) {
  const Vec3 offset = sphere.center - ray.origin;
  const double along = offset.dot(ray.direction);
  const double r = sphere.radius;
  const double passing = (offset - along * ray.direction).norm();
  if (!(passing < r)) return 0;  // a tangent does not cross
  const double half_chord = std::sqrt((r - passing) * (r + passing));
  // One of the two roots along -+ half_chord can cancel. Their product is the power of the origin, which gives the
  // other root without cancellation.
  const double distance = offset.norm();
  const double power = (distance - r) * (distance + r);
  const double far = along >= 0 ? along + half_chord : along - half_chord;
  const double near = far != 0 ? power / far : 0;
  int count = 0;
  for (const double t : {std::min(near, far), std::max(near, far)}) {
    if (!(t > 0)) continue;
    Crossing& crossing = crossings[count++];
    const Vec3 outside = (ray.at(t) - sphere.center).normalized();
    crossing.t = t;
    crossing.position = sphere.center + r * outside;
    crossing.outward = t == std::min(near, far);  // the nearer root enters
    crossing.normal = crossing.outward ? outside : Vec3(-outside);
  }
  return count;
}

int cross_plane(const Ray& ray, const Plane& plane, Crossing& crossing) {
  const double height = plane.normal.dot(plane.point - ray.origin);
  const double speed = plane.normal.dot(ray.direction);
  const double t = height / speed;
  if (!(t > 0) || !std::isfinite(t)) return 0;
  const Point3 near = ray.at(t);
  crossing.t = t;
  crossing.position = near - plane.normal.dot(near - plane.point) * plane.normal;
  crossing.outward = speed < 0;
  crossing.normal = crossing.outward ? plane.normal : Vec3(-plane.normal);
  return 1;
}

}  // namespace airlight::scene
