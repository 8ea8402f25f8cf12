// Vectors of Zhou et al. 2008 that no renderer computes to their own accuracy: diffusion in closed form, slabs, a half
// space and a ball, by solvers that are written for them. Tests of the method's own solvers in these cases are in
// tests/methods/compensated_ray_marching.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/verify/check.h"
#include "tests/oracle_vectors.h"
#include "tests/second_opinion/ball_transport.h"
#include "tests/second_opinion/diffusion_solutions.h"
#include "tests/second_opinion/slab_transport.h"

namespace transport_vectors_test {

using namespace airlight;
using namespace airlight::test;

namespace {

using Numbers = std::vector<double>;

Diffusion diffusion_of(const json& in) { return {number(in["sigma_t"]), number(in["albedo"]), number(in["g"])}; }

// g^l, as many as matter, or four.
Numbers phase_of(double g, bool order_4) {
  Numbers all{1};
  while (int(all.size()) < (order_4 ? 4 : 60) && (order_4 || std::abs(all.back() * g) > 1e-15))
    all.push_back(all.back() * g);
  return all;
}

// Numbers of a vector with those that a solver found.
struct Pairs {
  std::vector<std::pair<double, double>> expected_and_got;
  void add(const json& expected, double got) { expected_and_got.emplace_back(number(expected), got); }
  void add(const json& expected, const Numbers& got) {
    REQUIRE(expected.size() == got.size());
    for (std::size_t i = 0; i < got.size(); ++i) add(expected[i], got[i]);
  }
};

Pairs point_source(const json& in, const json& e) {
  const Diffusion d = diffusion_of(in);
  Pairs p;
  p.add(e["sigma_tr"], d.sigma_tr());
  p.add(e["kappa"], d.kappa());
  p.add(e["sigma_eff"], d.sigma_eff());
  p.add(e["mean_radiance"], d.around_point(number(in["r"]), number(in["power"])));
  return p;
}

Pairs marshak_slab(const json& in, const json& e) {
  Diffusion d = diffusion_of(in);
  d.sigma_t *= number(in["D"]);
  const double thickness = number(in["thickness"]), source = number(in["J0"]);
  REQUIRE(number(in["J1"]) == 0);
  Pairs p;
  p.add(e["centre"], d.in_slab(source, thickness, thickness / 2));
  p.add(e["boundary"], d.in_slab(source, thickness, 0));
  p.add(e["quarter"], d.in_slab(source, thickness, thickness / 4));
  return p;
}

Pairs half_space(const json& in, const json& e) {
  const double albedo = number(in["albedo"]);
  REQUIRE(number(in["g"]) == 0);
  const HFunction h(albedo);
  const double root = std::sqrt(1 - albedo), one = h(1), half = h(0.5);
  Pairs p;
  p.add(e["H_mu1"], one);
  p.add(e["H_mu0p5"], half);
  p.add(e["plane_albedo_mu1"], 1 - one * root);
  p.add(e["plane_albedo_mu0p5"], 1 - half * root);
  p.add(e["spherical_albedo_diffuse"], 1 - 2 * root * h.first_moment());
  p.add(e["radiance_mu1_from_mu1_per_unit_flux"], albedo / (4 * pi) * one * one / 2);
  return p;
}

// By reciprocity the share of a beam that comes out is the radiance along it under even light.
Pairs slab_albedo(const json& in, const json& e) {
  SlabLight light;
  light.albedo = number(in["albedo"]);
  light.thickness = number(in["optical_thickness"]);
  light.phase = phase_of(number(in["g"]), false);
  const double mu = number(in["incidence_mu"]);
  const SlabTransport slab(light, 150);
  Pairs p;
  p.add(e["reflectance"], slab.radiance(0, -mu));
  p.add(e["transmittance"], slab.radiance(light.thickness, mu));
  return p;
}

SlabLight slab_light(const json& in, double thickness) {
  SlabLight light;
  light.thickness = thickness;
  light.albedo = number(in["albedo"]);
  light.top = number(in["inflow_top"]);
  light.bottom = number(in["inflow_bottom"]);
  return light;
}

// Means at optical depths and radiances at depths and cosines, for the whole phase function or its first four bands.
void add_slab(Pairs& p, SlabLight light, double g, const json& expected, const Numbers& depths,
              const std::vector<std::pair<double, double>>& depth_and_mu) {
  const auto add = [&](const json& e, bool order_4) {
    light.phase = phase_of(g, order_4);
    const SlabTransport slab(light);
    Numbers mean, media, radiance;
    for (const double depth : depths) {
      mean.push_back(slab.mean(depth));
      media.push_back(mean.back() - slab.reduced_moment(0, depth));
    }
    for (const auto& [depth, mu] : depth_and_mu) radiance.push_back(slab.radiance(depth, mu));
    p.add(e["mean_radiance"], mean);
    if (e.contains("mean_media_radiance")) p.add(e["mean_media_radiance"], media);
    p.add(e["radiance"], radiance);
    p.add(e["flux_leaving_top"], slab.flux_leaving(true));
    p.add(e["flux_leaving_bottom"], slab.flux_leaving(false));
  };
  if (!expected.contains("full_phase")) return add(expected, false);
  add(expected["full_phase"], false);
  add(expected["order4_phase"], true);
}

Pairs ordinates_slab(const json& in, const json& e) {
  SlabLight light = slab_light(in, number(in["optical_thickness"]));
  light.emission = number(in["emission_J0"]);
  const double g = number(in["g"]);
  const Numbers depths = numbers(in["tau"]);
  std::vector<std::pair<double, double>> depth_and_mu;
  for (const json& place : in["radiance_tau_mu"]) depth_and_mu.emplace_back(number(place[0]), number(place[1]));
  Pairs p;
  add_slab(p, light, g, e, depths, depth_and_mu);
  if (!e.contains("single_scattering_moments")) return p;
  const SlabTransport slab(light);
  for (std::size_t i = 0; i < depths.size(); ++i)
    for (int l = 0; l < 4; ++l)
      p.add(e["single_scattering_moments"][i][std::size_t(l)],
            light.albedo * std::pow(g, l) * slab.reduced_moment(l, depths[i]));
  return p;
}

// Scattering of a layer depends on its optical depth alone.
Pairs uneven_slab(const json& in, const json& e) {
  const double sigma_t = number(in["sigma_t"]), height = number(in["height"]), top = number(in["density_top"]),
               slope = (number(in["density_bottom"]) - top) / height;
  const auto depth = [&](double z) { return sigma_t * (top * z + 0.5 * slope * z * z); };
  Numbers depths;
  for (const json& z : in["z"]) depths.push_back(depth(number(z)));
  std::vector<std::pair<double, double>> depth_and_mu;
  for (const json& place : in["radiance_z_mu"]) depth_and_mu.emplace_back(depth(number(place[0])), number(place[1]));
  Pairs p;
  p.add(e["optical_depth"], depths);
  add_slab(p, slab_light(in, depth(height)), number(in["g"]), e, depths, depth_and_mu);
  return p;
}

Pairs ball(const json& in, const json& e) {
  REQUIRE(in["rbf_x_y_z_r_w"].size() == 1);
  REQUIRE(in["phase"] == "order 4: P_l with l < 4");
  const json& one = in["rbf_x_y_z_r_w"][0];
  const BallTransport ball(BallLight{number(in["sigma_t"]) * number(one[3]) * number(one[4]), number(in["cut"]),
                                     number(in["albedo"]), phase_of(number(in["g"]), true),
                                     number(in["environment_radiance"])});
  Numbers mean, reduced, flux, exit, passed;
  for (const double r : numbers(in["radius_over_r"])) {
    mean.push_back(ball.moment(0, r));
    reduced.push_back(ball.reduced_moment(0, r));
    flux.push_back(ball.moment(1, r));
  }
  for (const double b : numbers(in["impact_over_r"])) {
    exit.push_back(ball.exit_radiance(b));
    passed.push_back(ball.exit_transmittance(b));
  }
  Pairs p;
  p.add(e["mean_radiance"], mean);
  p.add(e["mean_reduced_radiance"], reduced);
  if (e.contains("mean_flux_moment")) p.add(e["mean_flux_moment"], flux);
  p.add(e["exit_radiance"], exit);
  p.add(e["exit_transmittance"], passed);
  return p;
}

}  // namespace

TEST_CASE("solvers of their own meet the vectors that no renderer computes", "[second_opinion]") {
  const std::pair<const char*, Pairs (*)(const json&, const json&)> kinds[] = {
      {"diffusion_point_source", point_source},
      {"diffusion_slab_marshak", marshak_slab},
      {"halfspace_albedo_isotropic", half_space},
      {"slab_albedo_mc", slab_albedo},
      {"sn_slab", ordinates_slab},
      {"multiple_scattering_slab_hetero", uneven_slab},
      {"multiple_scattering_sphere", ball}};
  for (const auto& [kind, solve] : kinds)
    for (const char* file : {"compensated_ray_marching", "other/compensated_ray_marching"}) {
      int vectors = 0, compared = 0;
      for (const json& v : vectors_of(file, kind)) {
        CAPTURE(file, v["id"].get<std::string>());
        ++vectors;
        for (const auto& [expected, got] : solve(v["input"], v["expected"]).expected_and_got) {
          ++compared;
          CHECK(std::abs(got - expected) <= number(v["rtol"]) * std::abs(expected) + number(v["atol"]));
        }
      }
      CAPTURE(file, kind);
      CHECK(vectors > 0);
      CHECK(compared > vectors);
    }
  // A reader that knows the kinds must find none here that it computes.
  for (const auto& [kind, solve] : kinds) {
    const auto read = experiments::verification::find_reader("compensated_ray_marching", kind);
    for (const json& v : vectors_of("compensated_ray_marching", kind))
      CHECK_FALSE(read(experiments::verification::Value(v, kind)).job);
  }
}

TEST_CASE("vectors of an even source are its closed form", "[second_opinion]") {
  const auto all = vectors_of("compensated_ray_marching", "diffusion_uniform_source");
  REQUIRE_FALSE(all.empty());
  for (const json& v : all) {
    const Diffusion smoke{5, number(v["input"]["albedo"])};
    CHECK(smoke.of_even_source(number(v["input"]["single_scatter_mean_source"])) ==
          Approx(number(v["expected"])).epsilon(1e-12));
  }
}

}  // namespace transport_vectors_test
