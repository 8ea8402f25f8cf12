// Shadows of objects on smoke and on surfaces, the objects as spheres: how much is visible from a point, in spherical harmonics. Zhou et al.
// 2008, after Ren et al. 2006: logarithms of visibility add, as optical depths do, and one exponential takes both.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "scene/media/region.h"

namespace airlight::compensated_ray_marching {

// Visibility around a sphere that hides directions within an angle of its centre, given by its cosine, in [-1, 1]: zonal coefficients about
// the direction to the centre, in closed form.
std::vector<double> visible_zonal(int order, double cosine);

// Half the angle that a sphere hides from x [rad]; nothing inside it or on it, where all is hidden.
std::optional<double> hidden_angle(const scene::Sphere&, const Point3& x);

using HarmonicExponential = std::function<Harmonics(const Harmonics&)>;

// Logarithms of visibility by the hidden angle, of `samples` equal steps from 0 to pi/2: zonal functions whose exponential, as that operator
// takes it, is the least squares nearest to the visibility: of exact_exponential there is one without error; squared ones are right to 5e-3
// up to 50 degrees, and miss 0.04 beyond. Their lengths grow quickly (order 4: 6 at 60 degrees, 18 at 80, 37 at 90): none is longer than
// `longest` without its mean, which costs 0.01 at 90 degrees.
class ShadowTable {
 public:
  // order 1 to 6. Throws Error for what is out of range.
  ShadowTable(int order, const HarmonicExponential&, int samples = 256, double longest = 10);
  int order() const { return order_; }
  // For a hidden angle of 0 to pi/2; linear between samples.
  std::vector<double> zonal(double angle) const;
  // RMS over the sphere of what the exponential misses the visibility by, of each sample.
  const std::vector<double>& errors() const { return errors_; }
  const std::vector<std::vector<double>>& samples() const { return samples_; }

 private:
  int order_;
  std::vector<std::vector<double>> samples_;
  std::vector<double> errors_;
};

constexpr double least_hidden = 0.5 * pi / 180;  // [rad]

// Logarithm of the visibility from x past all spheres, order^2 coefficients of lookup directions, to be added to minus an optical depth.
// Spheres that hide less than `least` [rad] are passed over. Nothing where x is inside a sphere: no light gets there.
std::optional<Harmonics> log_visibility(const std::vector<scene::Sphere>&, const Point3& x, const ShadowTable&,
                                        double least = least_hidden);

// The cosine of the angle to a normal, where it is above 0, as a zonal function of 1 to 6 bands; of odd ones above 1 nothing.
std::vector<double> cosine_zonal(int order);

// Irradiance on a surface [the light's unit times sr]: of light times what is visible, over the hemisphere around the normal. `visible` and
// `light`: order^2 coefficients of lookup directions; the cosine in as many bands, and at least 0. Throws
// Error where they do not fit.
Rgb irradiance(const Vec3& normal, const Harmonics& visible, const std::vector<Rgb>& light);

// Ours, for light in fixed directions: the share of a direction that is visible past all spheres, each edge spread evenly over an angle
// `spacing` [rad], that of the directions.
double visible_share(const std::vector<scene::Sphere>&, const Point3& x, const Vec3& toward, double spacing);

}  // namespace airlight::compensated_ray_marching
