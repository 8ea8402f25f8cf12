// Source radiance of single scattering at points of a sum of Gaussians under light from all around: J_ss(w) = albedo times the integral of
// phase, light and transmittance over the sphere. Zhou et al. 2008, section 5.3.
#pragma once
#include <functional>
#include <vector>

#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/sphere_shadow.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::compensated_ray_marching {

// Light of an environment: in harmonics of lookup directions, or as radiance from a direction (towards the light).
struct SourceLight {
  std::vector<Rgb> harmonics;
  std::function<Rgb(const Vec3&)> radiance;
};

// How what is left of the light in every direction is found.
//   paper_linear, paper_squared, series: the depths of all Gaussians added in harmonics, exponentiated by OL, HYB (of Ren et al. 2006; the
//     publication prints OL) or the product series, times the light by the triple product; as the publication does
//   directional: exact depths in fixed directions, whose transmittances times the light are projected once; nothing rings
enum class Transmittance { paper_linear, paper_squared, series, directional };

// The tables for this order. Computed on first use and cached; thread-safe.
const LinearExponential& linear_exponential(int order);
// The table for any kind of transmittance except `directional`.
const ShadowTable& shadow_table(int order, Transmittance);

constexpr double squaring_threshold = 0.5;  // of paper_squared
// Directions for the transmittance `directional`.
inline std::vector<Ordinate> transmittance_directions() { return ordinate_directions(8, 16, false); }

class SourceRadiance {
 public:
  // extinction: sigma_t of each channel [1/m]. phase: mean of P_l over the phase function, g^l for Henyey-Greenstein; its size is the order.
  // The constant of the sum is left out. objects: they hide the light, by logarithms of visibility, of `directional` by shares of directions.
  // directions: of `directional`, which alone asks the light for its radiance. Throws Error where light and phase function are not of one
  // order.
  SourceRadiance(scene::GaussianSum smoke, const Rgb& extinction, const Rgb& albedo, std::vector<double> phase,
                 SourceLight light, Transmittance, std::vector<Ordinate> directions = transmittance_directions(),
                 std::vector<scene::Sphere> objects = {});

  // order^2 coefficients of J_ss, of propagation directions.
  std::vector<Rgb> at(const Point3&) const;

  // The parts, of lookup directions. Minus the depth for an extinction of 1; transmittance; what is left of the light.
  Harmonics minus_depth(const Point3&) const;
  std::vector<Rgb> attenuated_light(const Point3&) const;

  // Irradiance on a surface: past the smoke and all objects but those of which `casts` is false.
  Rgb irradiance(const Point3&, const Vec3& normal, const std::function<bool(std::size_t object)>& casts) const;

 private:
  int order() const { return int(phase_.size()); }
  std::vector<Rgb> by_directions(const Point3&) const;
  Rgb left_of(std::size_t direction, const Point3&, const std::vector<scene::Sphere>& objects) const;
  std::vector<Harmonics> passed(const Point3&, const std::vector<scene::Sphere>& objects) const;

  scene::GaussianSum smoke_;
  Rgb extinction_, albedo_;
  std::vector<double> phase_;
  SourceLight light_;
  Transmittance kind_;
  DepthTable depths_;
  std::vector<scene::Sphere> objects_;
  const LinearExponential* linear_;       // null where it is not needed
  const ShadowTable* shadows_ = nullptr;  // where there are objects
  std::vector<Ordinate> directions_;
  std::vector<Harmonics> harmonics_;  // of the directions
  std::vector<Rgb> from_;             // radiance from each, times its weight
};

// From what is left of the light, in lookup directions, to source radiance in propagation directions: albedo (-1)^l phase_l.
std::vector<Rgb> scattered(std::vector<Rgb> light, const Rgb& albedo, const std::vector<double>& phase);

}  // namespace airlight::compensated_ray_marching
