// Zhou et al. 2008: source radiance at a point and what it is made of, the diffusion system at the centres.
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_on_device.h"
#include "experiments/verify/smoke_vector.h"
#include "gpu/compensated_ray_marching/centre_tables.h"
#include "gpu/compensated_ray_marching/diffusion_vectors.h"
#include "methods/compensated_ray_marching/diffusion_system.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "scene/math/sh_product.h"
#include "scene/math/spherical_harmonics.h"
#include "scene/phase.h"

namespace airlight::experiments::verification {
namespace {

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

// Harmonics of the transmittance seen from a point, and of the light behind it, projected pixel by pixel
// from the six sides of a cube.
struct Seen {
  std::vector<double> transmittance = std::vector<double>(16, 0.0), light = transmittance;
};
Seen seen_from(const Point3& x, const scene::Prepared& prepared, int side) {
  Seen seen;
  for (int face = 0; face < 6; ++face) {
    const Vec3 direction = (face % 2 ? 1.0 : -1.0) * Vec3::Unit(face / 2);
    scene::Camera camera = camera_along(x, direction);
    camera.vertical_fov = pi / 2;
    const scene::Film film = prepared.render({camera, side, side}, {1, {}}).film;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const Vec3 w = camera_ray(camera, i + 0.5, j + 0.5, side, side).direction;
        const double share = 4.0 / (side * side) * std::pow(w.dot(direction), 3);  // of the sphere, that of a pixel
        const std::vector<double> y = scene::evaluate_sh(4, w);
        for (std::size_t b = 0; b < 16; ++b) {
          seen.transmittance[b] += share * film.get("transmittance", i, j)[0] * y[b];
          seen.light[b] += share * film.get("surface", i, j)[0] * y[b];
        }
      }
  }
  return seen;
}
// From harmonics 3, 1 and 2: -x, -y and z times sqrt(3 / 4 pi).
std::vector<double> vector_of(const std::vector<double>& lit) {
  const double scale = std::sqrt(4 * pi / 3);
  return {-scale * lit[3], -scale * lit[1], scale * lit[2]};
}

// The diffusion system, row by row, as CentreSourcesOnDevice assembles it on the device.
struct System {
  std::vector<double> matrix, right;
};
System system_on_device(const std::vector<scene::Gaussian>& gaussians, const std::vector<double>& single,
                        double sigma_t, double albedo, double g, bool printed) {
  gpu::Context& context = gpu::Context::get();
  const std::size_t n = gaussians.size();
  const double transport = (1 - albedo * g) * sigma_t;
  const on::CentreTables tables(context, 2, crm::Transmittance::series, infinity, false);
  const auto program_of = [&](const char* file, const char* sums) -> gpu::Program& {
    on::Definitions definitions = tables.definitions();
    definitions["SUMS"] = sums;
    definitions["VECTORS"] = std::to_string(on::diffusion::vectors_of_least_squares);
    gpu::Program& p = on::program(context, file, 64, 1, definitions);
    p.set("gaussian_count", int(n));
    return p;
  };
  const gpu::Buffer centres(context, "centres", numbers_of(gaussians)), sources(context, "sources", single),
      matrix(context, "matrix", 8 * n * n), scales(context, "scales", 8 * n),
      vectors(context, "vectors", 8 * n * on::diffusion::vectors_of_least_squares), systems(context, "systems", 64);
  gpu::Program& of_matrix = program_of("diffusion_matrix", "5");
  centres.bind(on::at::centres);
  matrix.bind(on::at::matrix);
  scales.bind(on::at::row_scales);
  of_matrix.set("scaled", false);
  of_matrix.set_double("transport", transport);
  of_matrix.set_double("absorption", (1 - albedo) * sigma_t);
  of_matrix.dispatch(64 * int(n));
  gpu::Program& of_right = program_of("diffusion_right", "9");
  sources.bind(on::at::single_bands);
  vectors.bind(on::at::vectors);
  systems.bind(on::at::systems);
  of_right.set("first_system", 0);
  of_right.set("unknowns", int(n));
  of_right.set("channel[0]", 0);
  of_right.set_double("of_mean", printed ? -sigma_t / albedo : -sigma_t);
  of_right.set_double("of_gradient", sigma_t / ((printed ? 1 : 3) * transport));
  of_right.dispatch(64 * int(n));
  System system{matrix.download<double>(), vectors.download<double>()};
  system.right.resize(n);
  return system;
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
  return {"",
          [=](VerifyProfile) {
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
          },
          // At the middle node of a grid, from 128 directions and from 2048.
          [=](VerifyProfile) {
            const auto s = smoke_scene(smoke, sigma_t, albedo, g, light.harmonics);
            const double most = *std::max_element(radiance.begin(), radiance.end());
            Outcome o;
            for (const auto& [levels, error] : {std::pair("8", 0.05), {"32", 2e-3}}) {
              AtNodes nodes(*s, {{"cells", "3"}, {"levels", levels}, {"multiple", "none"}}, x, 3);
              std::vector<double> got;
              for (const Vec3& w : out) {
                const scene::Camera camera = camera_along(x + 2 * w, -w);
                // Around Gaussians without a cut nodes are so far away that there is no smoke at all; both are 2 % apart there.
                if (smoke.cutoff < infinity) o.add(nodes.difference(fmt::format("{} levels", levels), camera));
                got.push_back(nodes.at(nodes.towards(camera), {0, 0, 0}));
              }
              compare_all(o, fmt::format("{} levels, radiance", levels), radiance, got, {0, error * most});
            }
            // Ordinates, cell by cell, at other albedos.
            for (const double other : {0.9, 1.0}) {
              AtNodes nodes(*smoke_scene(smoke, sigma_t, other, g, light.harmonics),
                            {{"cells", "16"}, {"tolerance", "1e-6"}});
              const std::string what = fmt::format("albedo {}", other);
              o.add(truth(what + ", multiple scattering", nodes.grid.single_only().empty()));
              o.add(absolute(what + ", error", 0, nodes.source.error(), 3e-6));
              for (const Vec3& from : {Vec3(0.4, 0.5, 2.5), Vec3(-1, 2, 0.3)})
                o.add(nodes.difference(what, scene::look_at(from, {0.5, 0.5, 0.5}, Vec3::UnitY())));
            }
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
  return {"",
          [=](VerifyProfile) {
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
            compare_all(o, "irradiance", irradiance, vector_of(lit), t);
            compare_all(o, "transmittance", passed, all, t);
            compare_all(o, "light", left, lit, t);
            std::vector<double> columns;
            for (const Vec3& w : toward) columns.push_back(sigma_t * density_integral(smoke, Ray{x, w}, {0, infinity}));
            compare_all(o, "depth", depths, columns, t);
            return o;
          },
          [=](VerifyProfile) {
            const OneRay look(device_renderer, smoke_scene(smoke, sigma_t, 0, 0, light.harmonics),
                              {{"slices", "1024"}, {"cells", "4"}, {"multiple", "none"}});
            Outcome o;
            std::vector<double> clear, lit, got_clear, got_lit;
            for (std::size_t i = 0; i < toward.size(); ++i) {
              const scene::Film film = look({x, toward[i]});
              clear.push_back(std::exp(-depths[i]));
              lit.push_back(clear[i] * light.radiance(toward[i])[0]);
              got_clear.push_back(film.get("transmittance", 0, 0)[0]);
              got_lit.push_back(film.get("surface", 0, 0)[0]);
            }
            compare_all(o, "exp(-depth)", clear, got_clear, {parity, 0});
            compare_all(o, "light along a ray", lit, got_lit, {parity, 0});
            // By sums over pixels, of second order.
            const Seen coarse = seen_from(x, *look.prepared, 16), fine = seen_from(x, *look.prepared, 48);
            compare_all(o, "mean", means,
                        {fine.transmittance[0] / std::sqrt(4 * pi), fine.light[0] / std::sqrt(4 * pi)}, {3e-4, 0});
            const std::vector<double> vector = vector_of(fine.light);
            double most = 0;
            for (const double value : irradiance) most = std::hypot(most, value);
            o.add(absolute("irradiance", 0, distance(vector, irradiance) * std::sqrt(4 * pi), 3e-4 * most));
            const double error = std::max(distance(fine.transmittance, passed), distance(fine.light, left)),
                         before = std::max(distance(coarse.transmittance, passed), distance(coarse.light, left));
            o.add(absolute("transmittance", 0, distance(fine.transmittance, passed), 3e-4));
            o.add(absolute("light", 0, distance(fine.light, left), 3e-4));
            o.add(absolute("error of 48 over 16 pixels a side", 0, error / before, 0.3));
            return o;
          }};
}

Check read_collocation_matrix(const Value& v) {
  const Value in = v["input"], sources = in["Jss_sh_order2"];
  const std::vector<scene::Gaussian> gaussians = gaussians_of(in).gaussians;
  const std::size_t n = gaussians.size();
  std::vector<crm::LinearSource> linear;
  if (sources.size() != n) sources.complain("a source for every Gaussian");
  std::vector<double> single(3 * 4 * n, 0.0);  // [channel][band][centre]
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::vector<double> f = sources[i].numbers();
    if (f.size() != 4) sources[i].complain("four coefficients");
    linear.push_back(crm::linear_source(f.data()));
    for (std::size_t b = 0; b < 4; ++b) single[b * n + i] = f[b];
  }
  const double sigma_t = in["sigma_t"].number(), albedo = in["albedo"].number_in(0, 1), g = in["g"].number_in(-1, 1);
  std::vector<double> expected[2];
  for (const bool printed : {false, true}) {
    const Value e = v["expected"][printed ? "as_printed" : "corrected"];
    expected[printed] = e["b"].numbers();
    for (std::size_t h = 0; h < n; ++h)
      for (const double a : e["A"][h].numbers()) expected[printed].push_back(a);
  }
  const OwnTolerance t = tolerance_of(v);
  const auto compare_systems = [=](const auto& system_of, const OwnTolerance& t) {
    Outcome o;
    for (const bool printed : {false, true}) {
      const System system = system_of(printed);
      std::vector<double> got = system.right;
      got.insert(got.end(), system.matrix.begin(), system.matrix.end());
      compare_all(o, printed ? "as printed" : "corrected", expected[printed], got, t);
    }
    return o;
  };
  return {"",
          [=](VerifyProfile) {
            return compare_systems(
                [&](bool printed) {
                  const crm::DiffusionSystem s =
                      crm::diffusion_system(gaussians, linear, sigma_t, albedo, g,
                                            printed ? crm::DiffusionForm::as_printed : crm::DiffusionForm::corrected);
                  const Eigen::MatrixXd rows = s.matrix.transpose();
                  return System{{rows.data(), rows.data() + rows.size()}, {s.right.begin(), s.right.end()}};
                },
                t);
          },
          [=](VerifyProfile) {
            return compare_systems(
                [&](bool printed) { return system_on_device(gaussians, single, sigma_t, albedo, g, printed); },
                {t.relative, t.absolute + gpu::injected_error()});
          }};
}

}  // namespace airlight::experiments::verification
