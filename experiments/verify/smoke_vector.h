// Smoke and light from the inputs of Zhou et al. 2008's vectors.
#pragma once
#include "experiments/verify/entry.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/source_radiance.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::experiments::verification {

// "cut", in widths; null: none.
double cut_of(const Value& input);

// A list of x, y, z, width and amplitude.
scene::GaussianSum gaussians_of(const Value& input, const std::string& field = "rbf_x_y_z_r_w");

// x, y, z, width and amplitude of each Gaussian, in a row.
std::vector<double> numbers_of(const std::vector<scene::Gaussian>&);

// Lists of real spherical harmonics, each a colour's.
std::vector<Rgb> grey_harmonics(const Value& list);

// An environment that its harmonics say completely.
compensated_ray_marching::SourceLight environment_of(const Value& input);

// The depth around x in four bands, exact, with its sign turned.
compensated_ray_marching::Harmonics minus_depth(const scene::GaussianSum&, const Point3& x, double sigma_t);

// Between two functions in harmonics: a root mean square over the sphere.
double distance(const compensated_ray_marching::Harmonics&, const compensated_ray_marching::Harmonics&);

// `variant = paper`, single scattering, exponentials by series.
inline compensated_ray_marching::Options paper_options(int order) {
  compensated_ray_marching::Options options;
  options.variant = compensated_ray_marching::Options::Variant::paper;
  options.order = order;
  options.paper.multiple = compensated_ray_marching::Options::Paper::Multiple::none;
  options.paper.transmittance = compensated_ray_marching::Transmittance::series;
  return options;
}

// Harmonics in directions, a value each; 1, g, g^2, g^3.
std::vector<double> evaluated(const std::vector<Rgb>& harmonics, const std::vector<Vec3>& directions);
std::vector<double> powers_of(double g);

// Levels of the directions from which light is gathered at a point: transmittances have root
// singularities at the Gaussians' cuts.
inline constexpr int levels_at_a_point = 256;

// Attenuated light at x from all directions: weight, incoming radiance and transmittance of each direction.
struct LeftOfLight {
  Vec3 toward;
  double weight, radiance, transmittance;
};
std::vector<LeftOfLight> light_left(const scene::GaussianSum&, double sigma_t, const std::vector<Rgb>& environment,
                                    const Point3& x, int levels);

}  // namespace airlight::experiments::verification
