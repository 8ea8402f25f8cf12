#include "experiments/verify/smoke_vector.h"

#include <cmath>

#include "experiments/application/json_value.h"
#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::experiments::verification {

namespace crm = compensated_ray_marching;

double cut_of(const Value& input) {
  return input["cut"].json().is_null() ? infinity : input["cut"].number_in(1e-3, 1e3);
}

scene::GaussianSum gaussians_of(const Value& input, const std::string& field) {
  const Value rows = input[field];
  scene::GaussianSum sum;
  sum.cutoff = cut_of(input);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> g = rows[i].numbers();
    if (g.size() != 5 || !(g[3] > 0)) rows[i].complain("x, y, z, a width above 0 and an amplitude");
    sum.gaussians.push_back({Point3(g[0], g[1], g[2]), g[3], g[4]});
  }
  return sum;
}

std::vector<double> numbers_of(const std::vector<scene::Gaussian>& gaussians) {
  std::vector<double> numbers;
  for (const scene::Gaussian& g : gaussians)
    numbers.insert(numbers.end(), {g.center[0], g.center[1], g.center[2], g.width, g.amplitude});
  return numbers;
}

std::vector<Rgb> grey_harmonics(const Value& list) {
  std::vector<Rgb> all;
  for (const double c : list.numbers()) all.push_back(Rgb::Constant(c));
  if (all.size() != 16) list.complain("16 coefficients");
  return all;
}

crm::SourceLight environment_of(const Value& input) {
  crm::SourceLight light{grey_harmonics(input["environment_sh_lookup"]), {}};
  light.radiance = [sh = light.harmonics](const Vec3& w) { return scene::evaluate_sh(sh, w); };
  return light;
}

crm::Harmonics minus_depth(const scene::GaussianSum& smoke, const Point3& x, double sigma_t) {
  crm::Harmonics sum(16, 0.0);
  for (const scene::Gaussian& g : smoke.gaussians) {
    const Vec3 way = g.center - x;
    const double d = way.norm();
    const crm::Harmonics one =
        crm::about_axis(crm::zonal_depth(4, d / g.width, smoke.cutoff), d > 0 ? Vec3(way / d) : Vec3(Vec3::UnitZ()));
    for (std::size_t i = 0; i < one.size(); ++i) sum[i] -= sigma_t * g.amplitude * g.width * one[i];
  }
  return sum;
}

std::vector<double> evaluated(const std::vector<Rgb>& harmonics, const std::vector<Vec3>& directions) {
  std::vector<double> values;
  for (const Vec3& w : directions) values.push_back(scene::evaluate_sh(harmonics, w)[0]);
  return values;
}

double distance(const crm::Harmonics& a, const crm::Harmonics& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(a[i] - b.at(i), 2);
  return std::sqrt(sum / (4 * pi));
}

std::vector<double> powers_of(double g) { return {1, g, g * g, g * g * g}; }

std::vector<LeftOfLight> light_left(const scene::GaussianSum& smoke, double sigma_t,
                                    const std::vector<Rgb>& environment, const Point3& x, int levels) {
  std::vector<LeftOfLight> all;
  for (const crm::Ordinate& d : crm::ordinate_directions(levels, 2 * levels, false))
    all.push_back({d.direction, d.weight, scene::evaluate_sh(environment, d.direction)[0],
                   std::exp(-sigma_t * density_integral(smoke, Ray{x, d.direction}, {0, infinity}))});
  return all;
}

}  // namespace airlight::experiments::verification
