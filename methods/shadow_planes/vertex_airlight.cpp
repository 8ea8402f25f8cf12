#include "methods/shadow_planes/vertex_airlight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::shadow_planes {
namespace {

// Barycentric coordinates of a point in the plane of a triangle; their sum is 1.
Vec3 barycentric(const Point3& a, const Point3& b, const Point3& c, const Point3& x) {
  const Vec3 normal = (b - a).cross(c - a);
  const double wb = (x - a).cross(c - a).dot(normal), wc = (b - a).cross(x - a).dot(normal);
  const double all = normal.squaredNorm();
  return {1 - wb / all - wc / all, wb / all, wc / all};
}

Rgb mix(const std::vector<Rgb>& values, const std::array<int, 3>& vertex, const Vec3& weight) {
  return weight[0] * values[vertex[0]] + weight[1] * values[vertex[1]] + weight[2] * values[vertex[2]];
}

}  // namespace

VertexAirlight::VertexAirlight(const AirlightTerm& term, const scene::Light& light, const Point3& camera)
    : air_(term), light_(light), camera_(camera) {}

Rgb VertexAirlight::gamma(const Vertex& vertex) const {
  const Vec3 way = vertex.at_infinity ? vertex.place : Vec3(vertex.place - camera_);
  const double length = way.norm();
  if (!(length > 0)) return Rgb::Zero();
  const Ray ray{camera_, way / length};
  double end = vertex.at_infinity ? infinity : length;
  const scene::LightBall ball = *scene::ball(light_);
  const LightFromRay from = light_from_ray(ray, ball.center);
  const double radius = std::max(ball.radius, 1e-6 * (ball.center - camera_).norm());
  if (from.h < radius) {
    const double half = std::sqrt((radius - from.h) * (radius + from.h));
    if (from.T + half > 0) end = std::min(end, from.T - half);
  }
  return end > 0 ? airlight(air_, light_, ray, {0, end}) : Rgb::Zero();
}

template <class VertexOf>
std::vector<Rgb> VertexAirlight::evaluate(std::size_t count, int threads, VertexOf&& vertex_of) {
  constexpr std::size_t chunk = 64;
  std::vector<Rgb> values(count);
  scene::parallel_for(int((count + chunk - 1) / chunk), {threads, {}}, [&](int k) {
    for (std::size_t i = k * chunk; i < std::min(count, (k + 1) * chunk); ++i) values[i] = gamma(vertex_of(i));
  });
  count_ += count;
  return values;
}

void VertexAirlight::evaluate_surfaces(const std::vector<scene::Surface>& surfaces, const Box& within, int threads) {
  surfaces_.resize(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto* mesh = std::get_if<scene::TriangleMesh>(&surfaces[s].shape);
    if (!mesh) continue;
    Box box;
    for (const Point3& vertex : mesh->vertices) box = unite(box, Box{vertex, vertex});
    if (intersect(box, within).empty()) continue;
    surfaces_[s] = evaluate(mesh->vertices.size(), threads, [&](std::size_t i) { return Vertex{mesh->vertices[i]}; });
  }
}

void VertexAirlight::evaluate_boundary(const MediaBoundary& boundary, int threads) {
  boundary_ =
      evaluate(boundary.vertices().size(), threads, [&](std::size_t i) { return Vertex{boundary.vertices()[i]}; });
}

void VertexAirlight::evaluate_planes(PlaneMesh mesh, int threads) {
  mesh_ = std::move(mesh);
  planes_ = evaluate(mesh_->vertices().size(), threads, [&](std::size_t i) { return mesh_->vertices()[i]; });
}

std::optional<Rgb> VertexAirlight::on_surface(const std::vector<scene::Surface>& surfaces,
                                              const scene::Hit& hit) const {
  const std::vector<Rgb>& values = surfaces_[hit.surface];
  if (values.empty() || hit.triangle < 0) return {};
  const auto& mesh = std::get<scene::TriangleMesh>(surfaces[hit.surface].shape);
  const auto& t = mesh.triangles[hit.triangle];
  return mix(values, t, barycentric(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], hit.position));
}

Rgb VertexAirlight::on_boundary(const MediaBoundary& boundary, const MediaBoundary::Place& place) const {
  return mix(boundary_, boundary.triangles()[place.triangle], place.weight);
}

Rgb VertexAirlight::on_plane(const Crossing& crossing) const {
  const PlaneMesh::Place place = mesh_->locate(crossing);
  return mix(planes_, place.vertex, place.weight);
}

}  // namespace airlight::shadow_planes
