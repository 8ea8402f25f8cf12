// Zhou et al. 2008: light that was scattered any number of times, by diffusion and by the transport equation, in slabs, half spaces and a
// ball. Solved to the vectors' own accuracy here; what the method's own solver makes of the same cases its tests say.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/verify/ball_transport.h"
#include "experiments/verify/diffusion_solutions.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/slab_transport.h"
#include "experiments/verify/smoke_on_device.h"
#include "experiments/verify/smoke_vector.h"
#include "methods/compensated_ray_marching/diffusion_system.h"

namespace airlight::experiments::verification {
namespace {

constexpr double most_albedo = 1 - 1e-9;

Diffusion diffusion_of(const Value& in) {
  return {in["sigma_t"].number_in(1e-9, 1e9), in["albedo"].number_in(0, most_albedo), in["g"].number_in(-0.999, 0.999)};
}

// g^l, as many as matter, or four.
std::vector<double> phase_of(double g, bool order_4) {
  std::vector<double> all{1};
  while (int(all.size()) < (order_4 ? 4 : 60) && (order_4 || std::abs(all.back() * g) > 1e-15))
    all.push_back(all.back() * g);
  return all;
}

double relative_distance(const std::vector<double>& got, const std::vector<double>& expected) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error += std::pow(got.at(i) - expected[i], 2);
    size += expected[i] * expected[i];
  }
  return std::sqrt(error / size);
}

struct Places {
  std::vector<double> depth;                            // optical
  std::vector<std::pair<double, double>> depth_and_mu;  // of radiances
};

// Expected numbers of a slab, of one phase function.
struct SlabNumbers {
  std::string name;
  bool order_4;
  std::vector<double> mean, media, radiance;
  double flux_top, flux_bottom;
};

std::vector<SlabNumbers> slab_numbers(const Value& expected, const Places& places) {
  std::vector<SlabNumbers> all;
  const auto add = [&](const Value& e, const std::string& name) {
    all.push_back({name,
                   name == "order 4 ",
                   e["mean_radiance"].numbers(),
                   {},
                   e["radiance"].numbers(),
                   e["flux_leaving_top"].number(),
                   e["flux_leaving_bottom"].number()});
    if (e.has("mean_media_radiance")) all.back().media = e["mean_media_radiance"].numbers();
    if (all.back().mean.size() != places.depth.size() || all.back().radiance.size() != places.depth_and_mu.size())
      e.complain("a mean for every place, and every radiance");
  };
  if (!expected.has("full_phase")) {
    add(expected, "");
  } else {
    add(expected["full_phase"], "full ");
    add(expected["order4_phase"], "order 4 ");
  }
  return all;
}

void compare_slab(Outcome& o, SlabLight light, double g, const SlabNumbers& n, const Places& places, OwnTolerance t) {
  light.phase = phase_of(g, n.order_4);
  const SlabTransport slab(light);
  std::vector<double> mean, media, radiance;
  for (const double depth : places.depth) {
    mean.push_back(slab.mean(depth));
    if (!n.media.empty()) media.push_back(mean.back() - slab.reduced_moment(0, depth));
  }
  for (const auto& [depth, mu] : places.depth_and_mu) radiance.push_back(slab.radiance(depth, mu));
  compare_all(o, n.name + "mean", n.mean, mean, t);
  compare_all(o, n.name + "scattered mean", n.media, media, t);
  compare_all(o, n.name + "radiance", n.radiance, radiance, t);
  o.add(compare(n.name + "flux at the top", n.flux_top, slab.flux_leaving(true), t));
  o.add(compare(n.name + "flux at the bottom", n.flux_bottom, slab.flux_leaving(false), t));
}

SlabLight slab_light(const Value& in) {
  SlabLight light;
  light.albedo = in["albedo"].number_in(0, most_albedo);
  light.top = in["inflow_top"].number_in(0, 1e6);
  light.bottom = in["inflow_bottom"].number_in(0, 1e6);
  return light;
}

}  // namespace

Check read_diffusion_point_source(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  const Diffusion d = diffusion_of(in);
  const double r = in["r"].number_in(1e-9, 1e9), power = in["power"].number();
  const std::vector<double> expected{e["sigma_tr"].number(), e["kappa"].number(), e["sigma_eff"].number(),
                                     e["mean_radiance"].number()};
  return by_own_solver(
      {"", [=, t = tolerance_of(v)](VerifyProfile) {
         Outcome o;
         compare_all(o, "", expected, {d.sigma_tr(), d.kappa(), d.sigma_eff(), d.around_point(r, power)}, t);
         return o;
       }});
}

Check read_diffusion_uniform_source(const Value& v) {
  const Value in = v["input"];
  const double albedo = in["albedo"].number_in(0, most_albedo), source = in["single_scatter_mean_source"].number();
  const double expected = v["expected"].number();
  return {"", [=, t = tolerance_of(v)](VerifyProfile) {
            // The publication's box is closed: smoke in it is smoke without end.
            const crm::DiffusionSystem s = crm::diffusion_system({{Point3::Zero(), 0.1, 0.7}}, {{source, Vec3::Zero()}},
                                                                 5, albedo, 0.3, crm::DiffusionForm::corrected);
            const double got =
                crm::solve_least_squares(s, Eigen::VectorXd::Zero(1), 10, 1e-15, crm::LeastSquaresSolver::cg).x[0];
            Outcome o;
            o.add(compare("at a centre", expected, got, t));
            o.add(compare("closed form", expected, Diffusion{5, albedo}.of_even_source(source), t));
            return o;
          }};
}

Check read_diffusion_slab_marshak(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  Diffusion d = diffusion_of(in);
  d.sigma_t *= in["D"].number_in(1e-9, 1e9);
  const double thickness = in["thickness"].number_in(1e-9, 1e9), source = in["J0"].number();
  if (in["J1"].number() != 0) return not_yet("diffusion of a source that has a direction");
  const std::vector<double> expected{e["centre"].number(), e["boundary"].number(), e["quarter"].number()};
  return by_own_solver({"", [=, t = tolerance_of(v)](VerifyProfile) {
                          Outcome o;
                          compare_all(o, "", expected,
                                      {d.in_slab(source, thickness, thickness / 2), d.in_slab(source, thickness, 0),
                                       d.in_slab(source, thickness, thickness / 4)},
                                      t);
                          return o;
                        }});
}

Check read_halfspace_albedo_isotropic(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  const double albedo = in["albedo"].number_in(0, most_albedo);
  if (in["g"].number() != 0) in["g"].complain("0");
  std::vector<double> expected;
  for (const char* name : {"H_mu1", "H_mu0p5", "plane_albedo_mu1", "plane_albedo_mu0p5", "spherical_albedo_diffuse",
                           "radiance_mu1_from_mu1_per_unit_flux"})
    expected.push_back(e[name].number());
  return by_own_solver({"", [=, t = tolerance_of(v)](VerifyProfile) {
                          const HFunction h(albedo);
                          const double root = std::sqrt(1 - albedo), one = h(1), half = h(0.5);
                          Outcome o;
                          compare_all(o, "", expected,
                                      {one, half, 1 - one * root, 1 - half * root, 1 - 2 * root * h.first_moment(),
                                       albedo / (4 * pi) * one * one / 2},
                                      t);
                          return o;
                        }});
}

Check read_slab_albedo(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  SlabLight light;
  light.albedo = in["albedo"].number_in(0, most_albedo);
  light.thickness = in["optical_thickness"].number_in(1e-6, 100);
  light.phase = phase_of(in["g"].number_in(-0.9, 0.9), false);
  const double mu = in["incidence_mu"].number_in(1e-3, 1);
  const std::vector<double> expected{e["reflectance"].number(), e["transmittance"].number()};
  return by_own_solver({"", [=, t = tolerance_of(v)](VerifyProfile) {
                          // By reciprocity the share of a beam that comes out is the radiance along it under even light.
                          const SlabTransport slab(light, 150);
                          Outcome o;
                          compare_all(o, "", expected, {slab.radiance(0, -mu), slab.radiance(light.thickness, mu)}, t);
                          return o;
                        }});
}

Check read_sn_slab(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  SlabLight light = slab_light(in);
  light.thickness = in["optical_thickness"].number_in(1e-6, 100);
  light.emission = in["emission_J0"].number_in(0, 1e6);
  const double g = in["g"].number_in(-0.6, 0.6);
  Places places{in["tau"].numbers(), {}};
  for (std::size_t i = 0; i < in["radiance_tau_mu"].size(); ++i)
    places.depth_and_mu.emplace_back(in["radiance_tau_mu"][i][0].number_in(0, light.thickness),
                                     in["radiance_tau_mu"][i][1].number_in(-1, 1));
  const std::vector<SlabNumbers> numbers = slab_numbers(expected, places);
  std::vector<std::vector<double>> once;
  if (expected.has("single_scattering_moments"))
    for (std::size_t i = 0; i < places.depth.size(); ++i)
      once.push_back(expected["single_scattering_moments"][i].numbers());
  return by_own_solver({"", [=, t = tolerance_of(v)](VerifyProfile) {
                          Outcome o;
                          for (const SlabNumbers& n : numbers) compare_slab(o, light, g, n, places, t);
                          const SlabTransport slab(light);
                          for (std::size_t i = 0; i < once.size(); ++i) {
                            std::vector<double> moments;
                            for (int l = 0; l < 4; ++l)
                              moments.push_back(light.albedo * std::pow(g, l) *
                                                slab.reduced_moment(l, places.depth[i]));
                            compare_all(o, fmt::format("moments {}", i), once[i], moments, t);
                          }
                          return o;
                        }});
}

Check read_multiple_scattering_slab(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  SlabLight light = slab_light(in);
  const double sigma_t = in["sigma_t"].number_in(1e-9, 1e9), height = in["height"].number_in(1e-9, 1e9),
               top = in["density_top"].number_in(0, 1e9),
               slope = (in["density_bottom"].number_in(0, 1e9) - top) / height, g = in["g"].number_in(-0.6, 0.6);
  // What a layer scatters depends on its depth alone.
  const auto depth = [=](double z) { return sigma_t * (top * z + 0.5 * slope * z * z); };
  light.thickness = depth(height);
  Places places;
  for (const double z : in["z"].numbers()) places.depth.push_back(depth(z));
  for (std::size_t i = 0; i < in["radiance_z_mu"].size(); ++i)
    places.depth_and_mu.emplace_back(depth(in["radiance_z_mu"][i][0].number_in(0, height)),
                                     in["radiance_z_mu"][i][1].number_in(-1, 1));
  const std::vector<SlabNumbers> numbers = slab_numbers(expected, places);
  const std::vector<double> depths = expected["optical_depth"].numbers();
  return by_own_solver({"", [=, t = tolerance_of(v)](VerifyProfile) {
                          Outcome o;
                          compare_all(o, "depth", depths, places.depth, t);
                          for (const SlabNumbers& n : numbers) compare_slab(o, light, g, n, places, t);
                          return o;
                        }});
}

Check read_multiple_scattering_ball(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in);
  if (smoke.gaussians.size() != 1 || smoke.cutoff > 10) in.complain("one Gaussian, cut");
  if (in["phase"].text() != "order 4: P_l with l < 4") in["phase"].complain("order 4");
  const scene::Gaussian one = smoke.gaussians[0];
  const BallLight light{in["sigma_t"].number_in(0, 1e6) * one.amplitude * one.width, smoke.cutoff,
                        in["albedo"].number_in(0, 1), phase_of(in["g"].number_in(-1, 1), true),
                        in["environment_radiance"].number()};
  const std::vector<double> radii = in["radius_over_r"].numbers(), impacts = in["impact_over_r"].numbers();
  std::array<std::vector<double>, 5> numbers;
  const std::array<const char*, 5> names{"mean_radiance", "mean_reduced_radiance", "mean_flux_moment", "exit_radiance",
                                         "exit_transmittance"};
  for (std::size_t i = 0; i < 5; ++i)
    if (i != 2 || expected.has(names[i])) numbers[i] = expected[names[i]].numbers();
  const double albedo = in["albedo"].number(), g = in["g"].number(), radiance = in["environment_radiance"].number(),
               sigma_t = in["sigma_t"].number();
  return by_own_solver(
      {"",
       [=, t = tolerance_of(v)](VerifyProfile) {
         const BallTransport ball(light);
         std::array<std::vector<double>, 5> got;
         for (const double r : radii) {
           got[0].push_back(ball.moment(0, r));
           got[1].push_back(ball.reduced_moment(0, r));
           if (!numbers[2].empty()) got[2].push_back(ball.moment(1, r));
         }
         for (const double b : impacts) {
           got[3].push_back(ball.exit_radiance(b));
           got[4].push_back(ball.exit_transmittance(b));
         }
         Outcome o;
         for (std::size_t i = 0; i < 5; ++i) compare_all(o, names[i], numbers[i], got[i], t);
         return o;
       },
       [=](VerifyProfile) {
         Outcome o;
         double exit_errors[2], mean_errors[2];
         // A node of both grids; a source that has no direction, off which mean radiance can be read.
         const auto is_node = [](double r) { return 2 * r == std::round(2 * r); };
         const bool with_means = g == 0 && std::any_of(radii.begin(), radii.end(), is_node);
         const double far = std::max(1.0, 2 * smoke.cutoff * one.width);
         for (const int cells : {2, 6}) {  // a width
           const Given given{{"cells", std::to_string(6 * cells + 1)},
                             {"levels", "12"},
                             {"ordinate_levels", "4"},
                             {"slices", "1024"},
                             {"deepest_cell", "9"}};
           const bool fine = cells == 6;
           const std::string nodes = fine ? "fine" : "coarse";
           const auto centred = std::make_shared<const scene::Scene>(
               AtNodes::centred(*smoke_scene(smoke, sigma_t, albedo, g, {Rgb::Constant(radiance * std::sqrt(4 * pi))}),
                                one.center, (3 + 0.5 / cells) * one.width));
           const OneRay there(device_renderer, centred, given);
           std::optional<OneRay> here;
           if (!fine) here.emplace(processor_renderer, centred, given);  // the other is compared node by node
           std::vector<double> exits, passed, means, expected_means;
           for (const double b : impacts) {
             const Ray ray{one.center + Vec3(b * one.width, 0, far), -Vec3::UnitZ()};
             const scene::Film got = there(ray);
             exits.push_back(got.get("mean", 0, 0)[0]);
             passed.push_back(got.get("transmittance", 0, 0)[0]);
             if (here)
               o.add(relative("exit, as the processor's", (*here)(ray).get("mean", 0, 0)[0], exits.back(), parity));
           }
           compare_all(o, nodes + ", " + names[4], numbers[4], passed, {parity, 0});
           exit_errors[fine] = relative_distance(exits, numbers[3]);
           if (!with_means) continue;
           AtNodes at(*centred, given);
           const scene::Camera camera = camera_along(one.center + Vec3(0, 0, 2 * far), -Vec3::UnitZ());
           o.add(at.difference(nodes, camera));
           const auto values = at.towards(camera);
           for (std::size_t k = 0; k < radii.size(); ++k)
             for (int axis = 0; axis < 3 && is_node(radii[k]); ++axis) {
               Eigen::Vector3i place = Eigen::Vector3i::Zero();
               place[axis] = int(std::lround(radii[k] * cells));
               means.push_back(at.at(values, place) / albedo);
               expected_means.push_back(numbers[0][k]);
             }
           mean_errors[fine] = relative_distance(means, expected_means);
         }
         // 8 and 23 deep; cells of up to 2.2 and 0.75 depths, in the second case 6.4 and 2.1. Of second order: a ninth.
         const auto below = [&](const char* what, double error, double bound) {
           o.add(absolute(what, 0, error, bound));
         };
         const auto below_coarse = [&](const char* what, const double* errors) {
           if (errors[0] > 0.01) below(what, errors[1] / errors[0], 0.2);
         };
         below("error of exit_radiance", exit_errors[1], albedo < 0.95 ? 0.003 : 0.01);
         below_coarse("error of fine over coarse, exit_radiance", exit_errors);
         if (!with_means) return o;
         below("error of mean_radiance", mean_errors[1], 0.01);
         below_coarse("error of fine over coarse, mean_radiance", mean_errors);
         return o;
       }});
}

}  // namespace airlight::experiments::verification
