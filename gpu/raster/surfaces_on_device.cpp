#include "gpu/raster/surfaces_on_device.h"

#include <algorithm>
#include <cmath>

namespace airlight::gpu {

struct SurfacesOnDevice::Arrays {
  std::vector<double> vertices;
  std::vector<std::array<int, 4>> triangles;  // three vertices, surface
  std::vector<Solid> solids;
  std::vector<Run> runs;
  Box bounds, bounds_without_balls;

  void add(bool mesh, int first, int count) {
    if (count == 0) return;
    if (runs.empty() || runs.back().mesh != mesh) runs.push_back({mesh, first, 0});
    runs.back().count += count;
  }
  void add(const scene::TriangleMesh& mesh, int surface) {
    const int base = int(vertices.size() / 3);
    for (const Point3& v : mesh.vertices) {
      vertices.insert(vertices.end(), v.data(), v.data() + 3);
      bounds = unite(bounds, {v, v});
    }
    add(true, int(triangles.size()), int(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) triangles.push_back({base + t[0], base + t[1], base + t[2], surface});
  }
  void add(const Point3& p, double radius, const Vec3& normal, int kind, int surface) {
    add(false, int(solids.size()), 1);
    solids.push_back({{p[0], p[1], p[2]}, radius, {normal[0], normal[1], normal[2]}, kind, surface});
    bounds = unite(bounds, {p.array() - radius, p.array() + radius});
  }
};

namespace {

std::vector<scene::LightBall> balls_of(const scene::Scene& scene) {
  std::vector<scene::LightBall> balls;
  for (const scene::Light& light : scene.lights)
    if (const auto ball = scene::ball(light); ball && ball->radius > 0) balls.push_back(*ball);
  return balls;
}

}  // namespace

SurfacesOnDevice::Arrays SurfacesOnDevice::arrays(const scene::Scene& scene, bool with_balls) {
  Arrays arrays;
  for (int s = 0; s < int(scene.surfaces.size()); ++s) {
    const scene::Shape& shape = scene.surfaces[s].shape;
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&shape)) {
      arrays.add(*mesh, s);
    } else if (const auto* sphere = std::get_if<scene::Sphere>(&shape)) {
      arrays.add(sphere->center, sphere->radius, Vec3::Zero(), 1, s);
    } else {
      const auto& plane = std::get<scene::Plane>(shape);
      arrays.add(plane.point, 0, plane.normal, 0, s);
    }
  }
  arrays.bounds_without_balls = arrays.bounds;
  if (with_balls)
    for (const scene::LightBall& ball : balls_of(scene)) arrays.add(ball.center, ball.radius, Vec3::Zero(), 2, -2);
  return arrays;
}

bool SurfacesOnDevice::move_balls(const scene::Scene& scene) {
  const std::vector<scene::LightBall> balls = balls_of(scene);
  const auto is_ball = [](const Solid& solid) { return solid.kind == 2; };
  const auto first = std::find_if(solids_.begin(), solids_.end(), is_ball);  // they are the last ones
  if (balls.size() != std::size_t(solids_.end() - first)) return false;
  if (balls.empty()) return true;
  bounds_ = bounds_without_balls_;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Point3& p = balls[i].center;
    const double radius = balls[i].radius;
    first[i] = {{p[0], p[1], p[2]}, radius, {0, 0, 0}, 2, -2};
    bounds_ = unite(bounds_, {p.array() - radius, p.array() + radius});
  }
  solid_buffer_.upload(solids_);
  return true;
}

SurfacesOnDevice::SurfacesOnDevice(Context& context, const scene::Scene& scene, bool with_balls)
    : SurfacesOnDevice(context, arrays(scene, with_balls)) {}

SurfacesOnDevice::SurfacesOnDevice(Context& context, const Arrays& arrays)
    : runs_(arrays.runs),
      solids_(arrays.solids),
      triangle_count_(int(arrays.triangles.size())),
      vertex_count_(int(arrays.vertices.size() / 3)),
      bounds_(arrays.bounds),
      bounds_without_balls_(arrays.bounds_without_balls),
      vertices_(context, "vertices", arrays.vertices),
      triangles_(context, "triangles", arrays.triangles),
      solid_buffer_(context, "solids", arrays.solids) {}

void SurfacesOnDevice::bind() const {
  vertices_.bind(10);
  triangles_.bind(11);
  solid_buffer_.bind(12);
}

double SurfacesOnDevice::extent(const Point3& position) const {
  if (bounds_.empty()) return 1;
  const double extent = (bounds_.lo - position).cwiseAbs().cwiseMax((bounds_.hi - position).cwiseAbs()).stableNorm();
  return extent > 0 ? extent : 1;
}

}  // namespace airlight::gpu
