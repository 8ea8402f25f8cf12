// Zhou et al. 2008: source radiance at a point and what it is made of, the diffusion system at the centres.
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_vector.h"
#include "methods/compensated_ray_marching/diffusion_system.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "scene/math/sh_product.h"
#include "scene/phase.h"

namespace airlight::experiments::verification {
namespace {

namespace crm = compensated_ray_marching;

std::vector<double> first_channel(const std::vector<Rgb>& colours) {
  std::vector<double> values;
  for (const Rgb& c : colours) values.push_back(c[0]);
  return values;
}

std::vector<Vec3> directions_of(const Value& list) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < list.size(); ++i) all.push_back(list[i].vector().normalized());
  return all;
}

}  // namespace

Check read_single_scattering_source(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in);
  const double sigma_t = in["sigma_t"].number(), albedo = in["albedo"].number_in(0, 1), g = in["g"].number_in(-1, 1);
  const crm::SourceLight light = environment_of(in);
  const Point3 x = in["point"].vector();
  const std::vector<Vec3> out = directions_of(in["propagation_directions"]);
  const std::vector<double> projection = expected["exact_projection"].numbers(),
                            radiance = expected["exact_radiance"].numbers(),
                            depth = expected["minus_depth_vector"].numbers(),
                            limited = expected["band_limited"].numbers(),
                            limited_radiance = expected["band_limited_radiance"].numbers();
  const OwnTolerance t = tolerance_of(v);
  return {"", [=](VerifyProfile) {
            Outcome o;
            const crm::SourceRadiance exact(smoke, Rgb::Constant(sigma_t), Rgb::Constant(albedo), powers_of(g), light,
                                            crm::Transmittance::directional,
                                            crm::ordinate_directions(levels_at_a_point, 2 * levels_at_a_point, false));
            compare_all(o, "exact", projection, first_channel(exact.at(x)), t);
            std::vector<double> sent(out.size(), 0.0);
            const scene::PhaseFunction phase = scene::HenyeyGreenstein{g};
            for (const LeftOfLight& l : light_left(smoke, sigma_t, light.harmonics, x, levels_at_a_point))
              for (std::size_t i = 0; i < out.size(); ++i)
                sent[i] += albedo * l.weight * l.radiance * l.transmittance * phase_value(phase, -l.toward.dot(out[i]));
            compare_all(o, "radiance", radiance, sent, t);
            const crm::Harmonics minus = minus_depth(smoke, x, sigma_t);
            compare_all(o, "depth", depth, minus, t);
            const std::vector<Rgb> all =
                crm::scattered(scene::triple_product(4)(light.harmonics, crm::exact_exponential(minus)),
                               Rgb::Constant(albedo), powers_of(g));
            compare_all(o, "band-limited", limited, first_channel(all), t);
            compare_all(o, "band-limited radiance", limited_radiance, evaluated(all, out), t);
            return o;
          }};
}

Check read_transmittance_environment(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in);
  const double sigma_t = in["sigma_t"].number();
  const crm::SourceLight light = environment_of(in);
  const Point3 x = in["point"].vector();
  const std::vector<Vec3> toward = directions_of(in["lookup_directions"]);
  const std::vector<double> means{expected["mean_transmittance"].number(),
                                  expected["mean_attenuated_radiance"].number()};
  const std::vector<double> irradiance = expected["vector_irradiance"].numbers(),
                            passed = expected["transmittance_projection"].numbers(),
                            left = expected["attenuated_light_projection"].numbers(),
                            depths = expected["optical_depth"].numbers();
  const OwnTolerance t = tolerance_of(v);
  return {"", [=](VerifyProfile) {
            Outcome o;
            const auto projected = [&](const crm::SourceLight& of) {
              return crm::SourceRadiance(smoke, Rgb::Constant(sigma_t), Rgb::Ones(), powers_of(0), of,
                                         crm::Transmittance::directional,
                                         crm::ordinate_directions(levels_at_a_point, 2 * levels_at_a_point, false))
                  .attenuated_light(x);
            };
            crm::SourceLight even;
            even.radiance = [](const Vec3&) { return Rgb(Rgb::Ones()); };
            const std::vector<double> all = first_channel(projected(even)), lit = first_channel(projected(light));
            compare_all(o, "mean", means, {all[0] / std::sqrt(4 * pi), lit[0] / std::sqrt(4 * pi)}, t);
            // Harmonics 3, 1 and 2 are -x, -y and z times sqrt(3 / 4 pi).
            const double scale = std::sqrt(4 * pi / 3);
            compare_all(o, "irradiance", irradiance, {-scale * lit[3], -scale * lit[1], scale * lit[2]}, t);
            compare_all(o, "transmittance", passed, all, t);
            compare_all(o, "light", left, lit, t);
            std::vector<double> columns;
            for (const Vec3& w : toward) columns.push_back(sigma_t * density_integral(smoke, Ray{x, w}, {0, infinity}));
            compare_all(o, "depth", depths, columns, t);
            return o;
          }};
}

Check read_collocation_matrix(const Value& v) {
  const Value in = v["input"], sources = in["Jss_sh_order2"];
  const std::vector<scene::Gaussian> gaussians = gaussians_of(in).gaussians;
  const std::size_t n = gaussians.size();
  std::vector<crm::LinearSource> linear;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::vector<double> f = sources[i].numbers();
    if (f.size() != 4) sources[i].complain("four coefficients");
    linear.push_back(crm::linear_source(f.data()));
  }
  if (linear.size() != n) sources.complain("a source for every Gaussian");
  const double sigma_t = in["sigma_t"].number(), albedo = in["albedo"].number_in(0, 1), g = in["g"].number_in(-1, 1);
  std::vector<double> expected[2];
  for (const bool printed : {false, true}) {
    const Value e = v["expected"][printed ? "as_printed" : "corrected"];
    expected[printed] = e["b"].numbers();
    for (std::size_t h = 0; h < n; ++h)
      for (const double a : e["A"][h].numbers()) expected[printed].push_back(a);
  }
  const OwnTolerance t = tolerance_of(v);
  return {"", [=](VerifyProfile) {
            Outcome o;
            for (const bool printed : {false, true}) {
              const crm::DiffusionSystem s =
                  crm::diffusion_system(gaussians, linear, sigma_t, albedo, g,
                                        printed ? crm::DiffusionForm::as_printed : crm::DiffusionForm::corrected);
              std::vector<double> got(s.right.begin(), s.right.end());
              for (Eigen::Index h = 0; h < s.right.size(); ++h)
                for (Eigen::Index l = 0; l < s.right.size(); ++l) got.push_back(s.matrix(h, l));
              compare_all(o, printed ? "as printed" : "corrected", expected[printed], got, t);
            }
            return o;
          }};
}

}  // namespace airlight::experiments::verification
