#include "methods/fogshop/radiance_transfer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/harmonic_reflection.h"
#include "scene/math/sh_product.h"
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

Rgb diffuse_albedo(const scene::Material& material) {
  return scene::match(
      material, [](const scene::Lambert& m) { return m.albedo; }, [](const scene::Phong& m) { return m.diffuse; },
      [](const scene::Tabulated&) { return Rgb(Rgb::Zero()); });
}

RadianceTransfer::RadianceTransfer(const scene::Scene& scene, int order, int rays, double reach, int bounces,
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
    scene::parallel_for((count + chunk - 1) / chunk, execution, [&](int row) {
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
        // Visibility: 1 in all directions, minus the hidden directions.
        float* into = &coefficients_[s][std::size_t(v) * size];
        for (int k = 0; k < size; ++k) into[k] = float((k == 0 ? std::sqrt(4 * pi) : 0.0) - sum[k] * (4 * pi / rays));
      }
    });
    rays_cast_ += std::accumulate(cast.begin(), cast.end(), 0.0);
  }
  if (bounces == 0) return;
  const std::vector<std::vector<Seen>> seen = look_around(scene, directions, reach, execution);
  for (int bounce = 0; bounce < bounces; ++bounce) reflect(scene, seen, 4 * pi / rays, execution);
}

// Radiance of every triangle of a mesh that directions of 1 in each harmonic make: what is open to its middle, and what
// has been reflected onto its vertices so far.
std::vector<std::vector<Rgb>> RadianceTransfer::sent_by_triangles(const scene::Scene& scene,
                                                                  std::size_t surface) const {
  const auto& mesh = std::get<scene::TriangleMesh>(scene.surfaces[surface].shape);
  const Rgb factor = diffuse_albedo(scene.surfaces[surface].material) / pi;
  const std::vector<double> cosine = clamped_cosine(order_);
  std::vector<std::vector<Rgb>> sent;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corner = mesh.triangles[t];
    SurfacePoint middle;
    middle.position = (mesh.vertices[corner[0]] + mesh.vertices[corner[1]] + mesh.vertices[corner[2]]) / 3;
    middle.normal = face_vector(mesh, corner).normalized();
    middle.surface = int(surface);
    middle.triangle = int(t);
    const std::vector<double> direct =
        scene::triple_product(order_)(turned_zonal(cosine, middle.normal), visibility(scene, middle));
    const std::vector<Rgb> again = reflected(scene, middle);
    std::vector<Rgb>& all = sent.emplace_back();
    for (std::size_t k = 0; k < direct.size(); ++k)
      all.push_back(factor * (direct[k] + (again.empty() ? Rgb(Rgb::Zero()) : again[k])));
  }
  return sent;
}

// Lists for every vertex of all meshes, in order, the triangles that it sees from their outer side.
std::vector<std::vector<RadianceTransfer::Seen>> RadianceTransfer::look_around(const scene::Scene& scene,
                                                                               const std::vector<Vec3>& directions,
                                                                               double reach,
                                                                               const scene::Execution& execution) {
  std::vector<std::vector<Seen>> seen;
  constexpr int chunk = 64;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (coefficients_[s].empty()) continue;
    const auto& mesh = std::get<scene::TriangleMesh>(scene.surfaces[s].shape);
    const auto faces = faces_at_vertices(mesh);
    const int count = int(mesh.vertices.size());
    const std::size_t first = seen.size();
    seen.resize(first + std::size_t(count));
    std::vector<double> cast(std::size_t(count), 0.0);
    scene::parallel_for((count + chunk - 1) / chunk, execution, [&](int row) {
      for (int v = row * chunk; v < std::min(count, (row + 1) * chunk); ++v) {
        Vec3 outward = Vec3::Zero();
        for (const Vec3& face : faces[std::size_t(v)]) outward += face;
        if (!(outward.norm() > 0)) continue;
        outward.normalize();
        const Point3 start = scene.geometry->offset_origin(mesh.vertices[std::size_t(v)], outward, outward);
        for (const Vec3& direction : directions) {
          const double cosine = outward.dot(direction);
          if (!(cosine > 0)) continue;
          ++cast[std::size_t(v)];
          const auto hit = scene.geometry->first_hit({start, direction}, reach);
          if (!hit || hit->triangle < 0) continue;
          const auto& met = std::get<scene::TriangleMesh>(scene.surfaces[std::size_t(hit->surface)].shape);
          if (face_vector(met, met.triangles[std::size_t(hit->triangle)]).dot(direction) < 0)
            seen[first + std::size_t(v)].push_back({hit->surface, hit->triangle, float(cosine)});
        }
      }
    });
    rays_cast_ += std::accumulate(cast.begin(), cast.end(), 0.0);
  }
  return seen;
}

// One bounce more, for all that has been reflected so far. `solid_angle`: of a direction [sr].
void RadianceTransfer::reflect(const scene::Scene& scene, const std::vector<std::vector<Seen>>& seen,
                               double solid_angle, const scene::Execution& execution) {
  const auto size = std::size_t(order_) * order_;
  std::vector<std::vector<std::vector<Rgb>>> sent(scene.surfaces.size());
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    if (!coefficients_[s].empty()) sent[s] = sent_by_triangles(scene, s);
  std::vector<std::vector<float>> reflections(scene.surfaces.size());
  constexpr int chunk = 64;
  std::size_t first = 0;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const int count = int(coefficients_[s].size() / size);
    reflections[s].assign(3 * std::size_t(count) * size, 0.0f);
    scene::parallel_for((count + chunk - 1) / chunk, execution, [&](int row) {
      std::vector<Rgb> sum(size);
      for (auto v = std::size_t(row) * chunk; v < std::size_t(std::min(count, (row + 1) * chunk)); ++v) {
        std::fill(sum.begin(), sum.end(), Rgb::Zero());
        for (const Seen& each : seen[first + v]) {
          const std::vector<Rgb>& from = sent[std::size_t(each.surface)][std::size_t(each.triangle)];
          for (std::size_t k = 0; k < size; ++k) sum[k] += double(each.cosine) * from[k];
        }
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t k = 0; k < size; ++k)
            reflections[s][(3 * v + c) * size + k] = float(sum[k][Eigen::Index(c)] * solid_angle);
      }
    });
    first += std::size_t(count);
  }
  reflections_ = std::move(reflections);
}

// The corners of the triangle that a point of the outer side of a mesh is on.
std::optional<RadianceTransfer::Corners> RadianceTransfer::corners(const scene::Scene& scene,
                                                                   const SurfacePoint& point) const {
  if (coefficients_[point.surface].empty() || point.triangle < 0) return std::nullopt;
  const auto& mesh = std::get<scene::TriangleMesh>(scene.surfaces[point.surface].shape);
  const auto& t = mesh.triangles[point.triangle];
  const Vec3 face = face_vector(mesh, t);
  if (!(face.dot(point.normal) > 0)) return std::nullopt;
  Corners result;
  double total = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = mesh.vertices[t[(i + 1) % 3]] - point.position, b = mesh.vertices[t[(i + 2) % 3]] - point.position;
    result.vertex[i] = std::size_t(t[i]);
    result.weight[i] = std::max(0.0, a.cross(b).dot(face));
    total += result.weight[i];
  }
  for (double& weight : result.weight) weight /= total;
  return result;
}

std::vector<double> RadianceTransfer::visibility(const scene::Scene& scene, const SurfacePoint& point) const {
  const auto at = corners(scene, point);
  if (!at) return {};
  const std::vector<float>& stored = coefficients_[point.surface];
  const std::size_t size = std::size_t(order_) * std::size_t(order_);
  std::vector<double> result(size, 0.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < size; ++k) result[k] += at->weight[i] * stored[at->vertex[i] * size + k];
  return result;
}

std::vector<Rgb> RadianceTransfer::reflected(const scene::Scene& scene, const SurfacePoint& point) const {
  if (reflections_.empty()) return {};
  const auto at = corners(scene, point);
  if (!at) return {};
  const std::vector<float>& stored = reflections_[point.surface];
  const std::size_t size = std::size_t(order_) * std::size_t(order_);
  std::vector<Rgb> result(size, Rgb::Zero());
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < size; ++k)
        result[k][Eigen::Index(c)] += at->weight[i] * stored[(3 * at->vertex[i] + c) * size + k];
  return result;
}

}  // namespace airlight::fogshop
