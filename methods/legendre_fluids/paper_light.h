// Light of one medium in Legendre coefficients: E_d of a direction, and E_s scattered along another, equations 22 to 24.
#pragma once
#include <optional>

#include "methods/legendre_fluids/light_system.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::legendre_fluids {

struct PaperOptions {
  int n = 6;  // coefficients of an intensity along an axis; along one where nothing varies 1
  LightTruncation truncation = LightTruncation::l2;
  LightSolver solver = {Closure::least_squares};
};

// The medium of a scene as the systems see it: a density with an extinction and a phase function. Several densities in one box that have
// both in common are one, whose albedo is a field: section 7, Figure 14.
struct PaperMedium {
  const scene::Medium* medium = nullptr;
  scene::LegendrePointer density;  // within the medium's region; null where nothing extinguishes
  // Scattering density, by channel: the sum of albedo times density; null: the medium's albedo times the density.
  std::array<scene::LegendrePointer, 3> scattering;
  // Channels that scatter alike, but for a factor where there is one albedo.
  bool alike(std::size_t channel, std::size_t other) const;
};
PaperMedium paper_medium(const scene::Scene&);
// The medium of a frame whose scene is `now`, where its fields are those of the frame before; nothing where they are not.
std::optional<PaperMedium> kept_medium(const PaperMedium&, const scene::Scene& before, const scene::Scene& now);
// Why the media are none such; empty if they are.
std::string several_against(const scene::Scene&);

// Shape of E_d and E_s: n along every axis, but 1 where the density is constant along the axis and nothing moves.
scene::TensorShape intensity_shape(const scene::TensorShape& density, int n, const std::array<bool, 3>& moving);

class PaperLight {
 public:
  // The box outlives this. `moving`: along which axes light or view do.
  PaperLight(const scene::LegendreBox&, const PaperOptions&, const std::array<bool, 3>& moving);
  const scene::TensorShape& shape() const { return product_.shape(); }

  // Coefficients of E_d for light that travels along a unit direction of the world, 1 where it comes in (eq. 22).
  Eigen::VectorXd direct(const Vec3& direction, double sigma, int* iterations = nullptr) const;
  // Coefficients of E_s along a direction (eq. 23). `scattering` (beta Omega) multiplies `what_scatters`, or the whole density
  // where that is null. E_s is linear in E_d: for several lights `direct` is their weighted sum.
  Eigen::VectorXd scattered(const Eigen::VectorXd& direct, const Vec3& direction, double sigma, double scattering,
                            const DensityProduct* what_scatters = nullptr, int* iterations = nullptr) const;
  // Restriction to the face `side` (-1 or 1) of an axis, n x n functions: the shape with 1 along the axis, with the
  // function L_0 (eq. 24).
  Eigen::VectorXd on_face(const Eigen::VectorXd& coefficients, int axis, int side) const;

 private:
  Vec3 rate(const Vec3& direction) const { return 2 * direction.cwiseQuotient(box_->box().size()); }
  const scene::LegendreBox* box_;
  PaperOptions options_;
  DensityProduct product_;
};

}  // namespace airlight::legendre_fluids
