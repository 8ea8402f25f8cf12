// Media as Legendre boxes under directional lights (environments are such lights already): what rays through them read. The preparation of variant `ray`.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "methods/legendre_fluids/light_columns.h"
#include "scene/scene.h"

namespace airlight::legendre_fluids {

struct LitMedium {
  const scene::Medium* medium;
  scene::LegendrePointer field;               // within the medium's region; homogeneous ones are of one coefficient
  std::optional<double> negative_share = {};  // of its box, where the density is below 0; nothing: not asked for yet
  // One for each light, once they are found; right to `rounding` [m].
  std::vector<std::shared_ptr<const LightColumns>> columns = {};
  double rounding = 0;
};

struct LitMedia {
  LitMedia() = default;
  // The scene outlives this, and has only fields of which `unsupported_field` names nothing. With `before`, the media of the frame before,
  // fields that have not changed are its fields.
  explicit LitMedia(const scene::Scene&, const LitMedia* before = nullptr);
  std::vector<scene::DirectionalLight> lights;  // those that shine
  std::vector<LitMedium> media;                 // those that extinguish
  int coefficients = 2;                         // enough for any density's integral along a ray
  bool grey = true;                             // are all extinctions the same in the three channels

  // Columns of all media towards all lights, with depths right to `rounding` [-]. Those of `before` are shared where medium and direction are
  // its own. How many were made.
  int find_columns(double rounding, const LitMedia* before = nullptr);
  double greatest_negative_share();

  // From a place towards a light, and along a ray [-], per channel. Need columns.
  Rgb light_depth(const Point3&, std::size_t light) const;
  Rgb view_depth(const Ray&, double end) const;
};

// Can a surface stand between a medium's box and a light: not if all of it lies behind the box, as seen from the light.
bool may_shadow(const scene::Surface&, const Box&, const Vec3& to_light);
// By light: can a surface stand between it and a medium.
std::vector<bool> shadowed_lights(const scene::Scene&, const LitMedia&);

// Why a medium is no polynomial in a box; empty if it is one.
std::string unsupported_field(const std::vector<scene::Medium>&, std::size_t i);
// A medium that is one, as such: its box is what of the field's lies in the medium's region; null if nothing does.
scene::LegendrePointer field_within_region(const scene::Medium&);
// Is what field_within_region makes of two media one density? Fields of scenes that were read again are compared by their contents.
bool same_density(const scene::Medium&, const scene::Medium&);
// Share of [-1, 1]^3 where a series is below 0, at Gauss points.
double negative_share(const scene::TensorShape&, const Eigen::VectorXd& coefficients);

}  // namespace airlight::legendre_fluids
