#include "methods/shadow_planes/bounded_media.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "methods/shadow_planes/options.h"

namespace airlight::shadow_planes {
namespace {

// Where the plane through the light and an edge meets the ray behind the edge.
void add_crossing(const Ray& ray, const LightFromRay& light, const Vec3& side, const Vec3& a, const Vec3& b,
                  std::vector<double>& places) {
  const double sa = side.dot(a), sb = side.dot(b);
  if ((sa >= 0) == (sb >= 0)) return;
  const Vec3 p = a + (b - a) * (sa / (sa - sb));
  const double towards = p.dot(light.n);
  if (towards > 0 && towards <= light.h) places.push_back(light.T + light.h * p.dot(ray.direction) / towards);
}

void add_box(const Box& box, const Ray& ray, const Point3& at, std::vector<double>& places) {
  const LightFromRay light = light_from_ray(ray, at);
  const Vec3 side = ray.direction.cross(at - ray.origin);
  const auto corner = [&](int i) {
    return Vec3(Vec3(i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1], i & 4 ? box.hi[2] : box.lo[2]) - at);
  };
  for (int i = 0; i < 8; ++i)
    for (int bit = 1; bit < 8; bit <<= 1)
      if (!(i & bit)) add_crossing(ray, light, side, corner(i), corner(i | bit), places);
}

// The tangent cone: (y . c)^2 = |y|^2 (|c|^2 - radius^2) from the light.
void add_sphere(const scene::Sphere& sphere, const Ray& ray, const Point3& at, std::vector<double>& places) {
  const Vec3 c = sphere.center - at, w = ray.direction, offset = at - ray.origin;
  const double outside = c.squaredNorm() - sphere.radius * sphere.radius;
  if (!(outside > 0)) return;
  const double A = w.dot(c) * w.dot(c) - outside, B = -offset.dot(c) * w.dot(c) + outside * offset.dot(w);
  const double C = offset.dot(c) * offset.dot(c) - outside * offset.squaredNorm(), D = B * B - A * C;
  if (D < 0) return;
  const double root = -(B + std::copysign(std::sqrt(D), B));
  if (A != 0) places.push_back(root / A);
  if (root != 0) places.push_back(C / root);
}

// The ways from the light through a region have kinks where they pass an edge, or graze it.
void add_kinks(const scene::Region& region, const Ray& ray, const Point3& at, std::vector<double>& places) {
  scene::match(
      region, [](const scene::Unbounded&) {}, [&](const Box& box) { add_box(box, ray, at, places); },
      [&](const scene::Sphere& sphere) { add_sphere(sphere, ray, at, places); }, [](const scene::Slab&) {});
}

}  // namespace

BoundedMedia::BoundedMedia(const std::vector<scene::Medium>& media, bool printed_phases) {
  for (const scene::Medium& medium : media)
    media_.push_back({extinction_of(medium), medium.albedo, phase_form(medium.phase, printed_phases), medium.region});
}

Rgb BoundedMedia::depth(const Ray& ray, double length) const {
  Rgb sum = Rgb::Zero();
  for (const Medium& medium : media_) {
    const Interval inside = clip(medium.region, ray, {0, length});
    if (inside.hi > inside.lo) sum += medium.extinction * (inside.hi - inside.lo);
  }
  return sum;
}

Interval BoundedMedia::extent(const Ray& ray, Interval t) const {
  Interval all;
  for (const Medium& medium : media_)
    if (const Interval inside = clip(medium.region, ray, t);
        !inside.empty() && (medium.albedo * medium.extinction > 0).any())
      all = {std::min(all.lo, inside.lo), std::max(all.hi, inside.hi)};
  return all;
}

std::vector<double> BoundedMedia::stretches(const Ray& ray, const Point3& light, Interval lit) const {
  std::vector<double> places;
  for (const Medium& medium : media_) {
    const Interval inside = clip(medium.region, ray, {0, infinity});
    if (inside.hi > inside.lo) {
      places.push_back(inside.lo);
      places.push_back(inside.hi);
    }
    add_kinks(medium.region, ray, light, places);
  }
  places.erase(std::remove_if(places.begin(), places.end(), [&](double x) { return !(x > lit.lo) || !(x < lit.hi); }),
               places.end());
  places.push_back(lit.lo);
  places.push_back(lit.hi);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace airlight::shadow_planes
