#include "scene/flow/particles.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/limits.h"
#include "scene/camera_rays.h"
#include "scene/math/random.h"

namespace airlight::scene {
namespace {

constexpr double nearest = 1e-3;  // [m] before the camera that a particle is seen

struct Sheet {
  Vec3 normal, along, beside;  // unit
};

// A random axis, and a random attitude about it: pure functions of seed and number.
Sheet sheet_of(const Particles& particles, std::size_t i) {
  const RandomBlock first{philox4x32_10({std::uint32_t(i), 0, 0, 0}, {particles.seed, 0x7368})};
  const RandomBlock second{philox4x32_10({std::uint32_t(i), 1, 0, 0}, {particles.seed, 0x7368})};
  const double z = 2 * first.coarse(0) - 1, turn = 2 * pi * first.coarse(1), r = std::sqrt(1 - z * z);
  const Vec3 axis(r * std::cos(turn), r * std::sin(turn), z);
  const double w = 2 * second.coarse(0) - 1, at = 2 * pi * second.coarse(1), q = std::sqrt(1 - w * w);
  const Vec3 start(q * std::cos(at), q * std::sin(at), w);
  const Eigen::AngleAxisd rotation(2 * pi * first.coarse(2) + particles.angle * (0.5 + first.coarse(3)), axis);
  Sheet sheet;
  sheet.normal = rotation * start;
  sheet.along = rotation * start.unitOrthogonal();
  sheet.beside = sheet.normal.cross(sheet.along);
  return sheet;
}

class Canvas {
 public:
  Canvas(const Camera& camera, int width, int height)
      : camera_(camera), rays_(camera, width, height), perspective_(camera.kind == Camera::Kind::perspective) {
    picture.width = width;
    picture.height = height;
    picture.radiance.assign(3 * std::size_t(width) * height, 0.0f);
    picture.depth.assign(std::size_t(width) * height, float(infinity));
    picture.fills = false;
  }

  // A particle with this middle, none of whose points is farther than `reach` from it. `depth_at` gives where the ray of a pixel's centre
  // meets it, along the axis of view; infinity where it does not.
  template <class DepthAt>
  void add(const Point3& middle, double reach, const Rgb& radiance, const DepthAt& depth_at) {
    const Part p = part(middle, reach);
    for (int j = p.y0; j <= p.y1; ++j)
      for (int i = p.x0; i <= p.x1; ++i) put(i, j, depth_at(rays_(i + 0.5, j + 0.5)), radiance);
    if (p.x >= 0 && p.y >= 0 && p.x < picture.width && p.y < picture.height) put(int(p.x), int(p.y), p.depth, radiance);
  }

  // Pixels that add() looks at.
  double pixels(const Point3& middle, double reach) const {
    const Part p = part(middle, reach);
    return std::max(0.0, p.x1 - p.x0 + 1.0) * std::max(0.0, p.y1 - p.y0 + 1.0);
  }

  Backdrop picture;

 private:
  struct Part {
    double x = -1, y = -1, depth = 0;  // of its middle
    int x0 = 0, x1 = -1, y0 = 0, y1 = -1;
  };
  Part part(const Point3& middle, double reach) const {
    const Vec3 to = middle - camera_.position;
    const double depth = to.dot(camera_.forward);
    if (!(depth > nearest)) return {};
    const double half = perspective_ ? depth * std::tan(0.5 * camera_.vertical_fov) : 0.5 * camera_.height;
    const double x = 0.5 * (picture.width + to.dot(camera_.right) / half * picture.height);
    const double y = 0.5 * (1 - to.dot(camera_.up) / half) * picture.height;
    // Tilted away from the camera its near edge looks larger than the middle.
    const double pixels =
        0.5 * picture.height * reach / half * (perspective_ ? depth / std::max(depth - reach, nearest) : 1) + 1;
    return {x,
            y,
            depth,
            first(x - pixels),
            last(x + pixels, picture.width),
            first(y - pixels),
            last(y + pixels, picture.height)};
  }
  static int first(double at) { return int(std::clamp(std::floor(at), 0.0, 1e6)); }
  static int last(double at, int size) { return int(std::clamp(std::ceil(at), -1.0, size - 1.0)); }
  void put(int x, int y, double depth, const Rgb& radiance) {
    const std::size_t pixel = std::size_t(y) * picture.width + x;
    if (!(depth > nearest && depth < picture.depth[pixel])) return;
    picture.depth[pixel] = float(depth);
    for (int c = 0; c < 3; ++c) picture.radiance[3 * pixel + c] = float(radiance[c]);
  }

  const Camera& camera_;
  CameraRays rays_;
  bool perspective_;
};

// Where a ray meets the plane through `middle`, as a length along it; infinity where it does not.
double plane_at(const Ray& ray, const Point3& middle, const Vec3& normal) {
  const double t = (middle - ray.origin).dot(normal) / ray.direction.dot(normal);
  return std::isfinite(t) && t > 0 ? t : infinity;
}

}  // namespace

Backdrop draw(const Particles& particles, const Camera& camera, int width, int height) {
  Canvas canvas(camera, width, height);
  double pixels = 0;
  const double reach = (particles.shape == Particles::Shape::disc ? 1 : std::sqrt(2.0)) * particles.radius;
  for (const Point3& middle : particles.positions) pixels += canvas.pixels(middle, reach);
  require_time(2e-8 * pixels, fmt::format("drawing {} particles", particles.positions.size()));
  for (std::size_t i = 0; i < particles.positions.size(); ++i) {
    const Point3& middle = particles.positions[i];
    const Rgb& radiance = particles.radiances[i % particles.radiances.size()];
    const double r = particles.radius;
    if (particles.shape == Particles::Shape::disc) {
      const double depth = (middle - camera.position).dot(camera.forward);
      canvas.add(middle, r, radiance, [&](const Ray& ray) {
        const double t = plane_at(ray, middle, camera.forward);
        return t < infinity && (ray.at(t) - middle).norm() <= r ? depth : infinity;
      });
      continue;
    }
    const Sheet sheet = sheet_of(particles, i);
    canvas.add(middle, std::sqrt(2.0) * r, radiance, [&](const Ray& ray) {
      const double t = plane_at(ray, middle, sheet.normal);
      if (t == infinity) return infinity;
      const Vec3 from = ray.at(t) - middle;
      const bool inside = std::abs(from.dot(sheet.along)) <= r && std::abs(from.dot(sheet.beside)) <= r;
      return inside ? t * ray.direction.dot(camera.forward) : infinity;
    });
  }
  return std::move(canvas.picture);
}

}  // namespace airlight::scene
