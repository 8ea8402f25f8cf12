#include "methods/fogshop/radiance_transfer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/math/spherical_harmonics.h"

namespace airlight::fogshop {
namespace {

// A spiral by the golden angle: each direction stands for the same solid angle.
std::vector<Vec3> spiral(int count) {
  const double golden = pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, r = std::sqrt((1 - z) * (1 + z)), phi = golden * i;
    directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return directions;
}

Vec3 face_vector(const scene::TriangleMesh& mesh, const std::array<int, 3>& t) {
  return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
}

// Unit normals of the faces that meet at every vertex.
std::vector<std::vector<Vec3>> faces_at_vertices(const scene::TriangleMesh& mesh) {
  std::vector<std::vector<Vec3>> faces(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 normal = face_vector(mesh, t).normalized();
    for (const int v : t) faces[v].push_back(normal);
  }
  return faces;
}

}  // namespace

double mesh_vertices(const scene::Scene& scene) {
  double count = 0;
  for (const scene::Surface& surface : scene.surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape)) count += double(mesh->vertices.size());
  return count;
}

RadianceTransfer::RadianceTransfer(const scene::Scene& scene, int order, int rays, double reach,
                                   const scene::Execution& execution)
    : order_(order), coefficients_(scene.surfaces.size()) {
  const std::vector<Vec3> directions = spiral(rays);
  std::vector<std::vector<double>> basis;
  for (const Vec3& direction : directions) basis.push_back(scene::evaluate_sh(order, direction));
  const int size = order * order;
  constexpr int chunk = 64;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const auto* mesh = std::get_if<scene::TriangleMesh>(&scene.surfaces[s].shape);
    if (!mesh) continue;
    const auto faces = faces_at_vertices(*mesh);
    const int count = int(mesh->vertices.size());
    coefficients_[s].assign(std::size_t(count) * size, 0.0f);
    std::vector<double> cast(count, 0.0);
    scene::parallel_rows((count + chunk - 1) / chunk, execution, [&](int row) {
      std::vector<double> sum(size);
      for (int v = row * chunk; v < std::min(count, (row + 1) * chunk); ++v) {
        Vec3 outward = Vec3::Zero();
        for (const Vec3& face : faces[v]) outward += face;
        std::fill(sum.begin(), sum.end(), 0.0);
        if (outward.norm() > 0) {
          outward.normalize();
          const Point3 start = scene.geometry->offset_origin(mesh->vertices[v], outward, outward);
          for (int i = 0; i < rays; ++i) {
            const Vec3& direction = directions[i];
            if (std::none_of(faces[v].begin(), faces[v].end(), [&](const Vec3& n) { return n.dot(direction) > 0; }))
              continue;
            ++cast[v];
            if (!scene.geometry->occluded({start, direction}, reach)) continue;
            for (int k = 0; k < size; ++k) sum[k] += basis[i][k];
          }
        }
        // What is hidden, taken from what is open everywhere.
        float* into = &coefficients_[s][std::size_t(v) * size];
        for (int k = 0; k < size; ++k) into[k] = float((k == 0 ? std::sqrt(4 * pi) : 0.0) - sum[k] * (4 * pi / rays));
      }
    });
    rays_cast_ += std::accumulate(cast.begin(), cast.end(), 0.0);
  }
}

std::vector<double> RadianceTransfer::visibility(const scene::Scene& scene, const SurfacePoint& point) const {
  const std::vector<float>& stored = coefficients_[point.surface];
  if (stored.empty() || point.triangle < 0) return {};
  const auto& mesh = std::get<scene::TriangleMesh>(scene.surfaces[point.surface].shape);
  const auto& t = mesh.triangles[point.triangle];
  const Vec3 face = face_vector(mesh, t);
  if (!(face.dot(point.normal) > 0)) return {};
  double weight[3], total = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = mesh.vertices[t[(i + 1) % 3]] - point.position, b = mesh.vertices[t[(i + 2) % 3]] - point.position;
    weight[i] = std::max(0.0, a.cross(b).dot(face));
    total += weight[i];
  }
  const int size = order_ * order_;
  std::vector<double> result(size, 0.0);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < size; ++k) result[k] += weight[i] / total * stored[std::size_t(t[i]) * size + k];
  return result;
}

}  // namespace airlight::fogshop
