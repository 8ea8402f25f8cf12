// The paper's evaluation: airlight at vertices, linear between them (Biri et al. 2006, sections 5.1.3, 5.1.5, 5.2).
#pragma once
#include <optional>

#include "methods/shadow_planes/airlight_term.h"
#include "methods/shadow_planes/media_boundary.h"
#include "methods/shadow_planes/plane_mesh.h"
#include "scene/renderer.h"

namespace airlight::shadow_planes {

// Gamma(vertex) of the paper, for one light and one air: the airlight [W/m^2/sr] that the ray from the camera to a
// vertex gathers if all of the ray is lit. A ray ends on the light's ball, like the rays of an image. Without a ball it
// ends within 1e-6 of the light's distance, since Gamma is infinite behind the light.
class VertexAirlight {
 public:
  VertexAirlight(const AirlightTerm&, const scene::Light&, const Point3& camera);  // keeps references to the first two

  // On all threads. Meshes that are not in `within` are left out.
  void evaluate_surfaces(const std::vector<scene::Surface>&, const Box& within, int threads);
  void evaluate_boundary(const MediaBoundary&, int threads);
  void evaluate_planes(PlaneMesh, int threads);

  // Nothing on a surface without vertices.
  std::optional<Rgb> on_surface(const std::vector<scene::Surface>&, const scene::Hit&) const;
  Rgb on_boundary(const MediaBoundary&, const MediaBoundary::Place&) const;
  Rgb on_plane(const Crossing&) const;

  std::size_t count() const { return count_; }  // of vertices
  std::size_t planes() const { return mesh_ ? mesh_->planes() : 0; }

 private:
  Rgb gamma(const Vertex&) const;
  template <class VertexOf>
  std::vector<Rgb> evaluate(std::size_t count, int threads, VertexOf&&);

  const AirlightTerm& air_;
  const scene::Light& light_;
  Point3 camera_;
  std::size_t count_ = 0;
  std::vector<std::vector<Rgb>> surfaces_;
  std::vector<Rgb> boundary_, planes_;
  std::optional<PlaneMesh> mesh_;
};

}  // namespace airlight::shadow_planes
