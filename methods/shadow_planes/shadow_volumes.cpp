#include "methods/shadow_planes/shadow_volumes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::shadow_planes {
namespace {

// Real roots of a t^2 + 2 b t + c.
void add_roots(double a, double b, double c, std::vector<double>& roots) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;
  const double root = -(b + std::copysign(std::sqrt(discriminant), b));
  if (a != 0) roots.push_back(root / a);
  if (root != 0) roots.push_back(c / root);
}

}  // namespace

Box scattering_box(const std::vector<scene::Medium>& media) {
  Box all;
  for (const scene::Medium& medium : media)
    if (extinguishes(medium) && (medium.albedo * medium.sigma_t > 0).any()) all = unite(all, bounding_box(medium));
  return all;
}

ShadowVolumes::ShadowVolumes(std::shared_ptr<const Occluders> occluders, const Point3& light, const Box& air,
                             const ShadowVolumes* before)
    : occluders_(std::move(occluders)), count_(occluders_, light, air), light_(light) {
  for (const std::size_t m : count_.meshes()) {
    const std::shared_ptr<const MeshEdges>& mesh = occluders_->meshes()[m];
    const OfMesh* kept = nullptr;
    if (before && before->light_ == light)
      for (const OfMesh& was : before->of_meshes_)
        if (was.mesh == mesh) kept = &was;
    const std::size_t first = edges_.size();
    if (kept) {
      const auto begin = before->edges_.begin() + long(kept->first);
      edges_.insert(edges_.end(), begin, begin + long(kept->count));
    } else {
      const std::vector<SilhouetteEdge> made = silhouette(*mesh, light);
      edges_.insert(edges_.end(), made.begin(), made.end());
      ++silhouettes_made_;
    }
    of_meshes_.push_back({mesh, first, edges_.size() - first});
  }
  all_.resize(edges_.size());
  std::iota(all_.begin(), all_.end(), 0);
}

void ShadowVolumes::cross_edges(const Ray& ray, double end, const std::vector<int>& edges,
                                std::vector<Crossing>& crossings) const {
  const LightFromRay light = light_from_ray(ray, light_);
  if (!(light.h > 1e-12 * (light_ - ray.origin).norm())) return;
  // Side of the plane through ray and light on which a vertex lies: equal for both edges that share the vertex, so that
  // no ray slips between them or meets both.
  const Vec3 side = ray.direction.cross(light_ - ray.origin);
  for (const int i : edges) {
    const SilhouetteEdge& edge = edges_[i];
    const double sa = side.dot(edge.a), sb = side.dot(edge.b);
    if ((sa >= 0) == (sb >= 0)) continue;
    const double share = sa / (sa - sb);
    const Vec3 p = edge.a + (edge.b - edge.a) * share;
    const double towards = p.dot(light.n), along = p.dot(ray.direction);
    if (!(towards > 0) || towards > light.h) continue;  // not between light and ray
    const double x = light.T + light.h * along / towards;
    if (!(x > 0) || !(x < end)) continue;
    const bool leaves = edge.a.cross(edge.b).dot(ray.direction) > 0;
    crossings.push_back({x, leaves ? -edge.multiplicity : edge.multiplicity, i, share, light.h / towards});
  }
}

void ShadowVolumes::cross_spheres(const Ray& ray, double end, std::vector<Crossing>& crossings) const {
  // The shadow of a ball is convex: one stretch of the ray, which ends on the tangent cone or on the ball.
  std::vector<double> places;
  for (const scene::Sphere& sphere : count_.spheres()) {
    const Vec3 c = sphere.center - light_, y = ray.origin - light_, w = ray.direction;
    places = {0};
    const double outside = c.squaredNorm() - sphere.radius * sphere.radius;
    add_roots(w.dot(c) * w.dot(c) - outside, y.dot(c) * w.dot(c) - outside * y.dot(w),
              y.dot(c) * y.dot(c) - outside * y.squaredNorm(), places);
    const Vec3 from_center = ray.origin - sphere.center;
    add_roots(1, from_center.dot(w), from_center.squaredNorm() - sphere.radius * sphere.radius, places);
    places.erase(std::remove_if(places.begin(), places.end(), [&](double t) { return !(t >= 0) || !(t < end); }),
                 places.end());
    std::sort(places.begin(), places.end());
    bool before = hides(c, sphere.radius, y);  // as count() has it
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double next =
          k + 1 < places.size() ? places[k + 1] : std::min(end, 2 * places[k] + 1 + c.norm() + y.norm());
      const bool hidden = hides(c, sphere.radius, y + 0.5 * (places[k] + next) * w);
      if (hidden != before)
        crossings.push_back(
            {places[k], hidden ? 2 : -2, -1, 0, 1, (y + places[k] * w).normalized().dot(y.normalized())});
      before = hidden;
    }
  }
}

void ShadowVolumes::lit_parts(const Ray& ray, double end, int count, const std::vector<int>* edges,
                              std::vector<Crossing>& crossings, std::vector<Interval>& lit) const {
  crossings.clear();
  lit.clear();
  const Vec3 offset = light_ - ray.origin;
  const LightFromRay light = light_from_ray(ray, light_);
  const scene::Geometry* geometry = occluders_->scene().geometry.get();
  if (!(light.h > 1e-12 * offset.norm())) {
    // Through the light: lit from it up to the first surface to both sides.
    double begin = 0, stop = end;
    if (geometry) {
      if (const auto hit = geometry->first_hit({light_, -ray.direction})) begin = std::max(begin, light.T - hit->t);
      if (const auto hit = geometry->first_hit({light_, ray.direction})) stop = std::min(stop, light.T + hit->t);
    }
    if (begin < stop) lit.push_back({begin, stop});
    return;
  }
  cross_edges(ray, end, edges ? *edges : all_, crossings);
  cross_spheres(ray, end, crossings);
  std::stable_sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  double from = 0;
  int m = count;
  for (const Crossing& crossing : crossings) {
    if (m == 0 && crossing.x > from) lit.push_back({from, crossing.x});
    m += crossing.change;
    from = crossing.x;
  }
  if (m == 0 && end > from) lit.push_back({from, end});
}

}  // namespace airlight::shadow_planes
