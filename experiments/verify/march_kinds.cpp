// Zhou et al. 2008: the march along rays, and the integral that it tends to.
#include <algorithm>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/march_on_device.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/ray_quadrature.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_on_device.h"
#include "experiments/verify/smoke_vector.h"
#include "methods/compensated_ray_marching/compensated_march.h"
#include "scene/math/spherical_harmonics.h"
#include "scene/phase.h"

namespace airlight::experiments::verification {
namespace {

constexpr int levels_on_a_ray = 64;

// Where a ray goes in and out of Gaussians, between two ends.
std::vector<double> crossings(const scene::GaussianSum& smoke, const Ray& ray, double from, double to) {
  std::vector<double> ends{from, to};
  for (const scene::Gaussian& g : smoke.gaussians) {
    const Vec3 way = g.center - ray.origin;
    const double along = way.dot(ray.direction), reach = smoke.cutoff * g.width;
    const double square = reach * reach - (way.squaredNorm() - along * along);
    ends.push_back(along);
    if (square > 0) ends.insert(ends.end(), {along - std::sqrt(square), along + std::sqrt(square)});
  }
  std::erase_if(ends, [&](double t) { return t < from || t > to; });
  std::sort(ends.begin(), ends.end());
  return ends;
}

std::vector<Ray> rays_of(const Value& list) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < list.size(); ++i)
    rays.push_back({list[i]["origin"].vector(), list[i]["direction"].vector().normalized()});
  return rays;
}

// The mean of sources weighted with the Gaussians, at least 0; nothing where the Gaussians are below 1e-10.
RaySample interpolated(const scene::GaussianSum& smoke, const std::vector<double>& sources, const Point3& x) {
  double sum = 0, weighted = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const scene::Gaussian& g = smoke.gaussians[i];
    const double square = (x - g.center).squaredNorm() / (g.width * g.width);
    if (square > smoke.cutoff * smoke.cutoff) continue;
    const double weight = g.amplitude * std::exp(-square);
    sum += weight;
    weighted += weight * sources[i];
  }
  return sum < 1e-10 ? RaySample{0, 0} : RaySample{sum, std::max(0.0, weighted / sum)};
}

// Densities in thousandths of ten: residuals of four decimals are then integers, which single precision keeps.
constexpr double unit = 1e4;

std::shared_ptr<scene::VoxelGrid> residual_of(const Value& values) {
  const int voxels = int(values.size());
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = Eigen::Vector3i::Constant(voxels);
  grid->voxel_size = 1.0 / voxels;
  grid->translation = Vec3::Constant(0.5 / voxels);
  grid->clamp_border = true;
  for (std::size_t k = 0; k < values.size(); ++k)
    for (std::size_t j = 0; j < values.size(); ++j)
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double integer = unit * values[i][j][k].number_in(-100, 100);
        if (std::abs(integer - std::round(integer)) > 1e-8) values[i][j][k].complain("a decimal of four places");
        grid->values.push_back(float(std::round(integer)));
      }
  return grid;
}

// The integral that the march tends to, over the first `length` of a ray. `sources`: of each Gaussian, towards the eye.
RayIntegral march_integral(const crm::MarchedSmoke& smoke, const std::vector<double>& sources, const Ray& ray,
                           double length) {
  std::vector<double> ends = crossings(smoke.gaussians, ray, 0, length);
  // A residual has kinks where the ray crosses the planes through voxels' centres, and those of the box.
  const int voxels = smoke.residual ? smoke.residual->size[0] : 0;
  for (int a = 0; a < 3 && voxels > 0; ++a)
    for (int i = -1; i <= voxels; ++i) {
      const double plane = std::clamp((i + 0.5) / voxels, 0.0, 1.0);
      const double at = (plane - ray.origin[a]) / ray.direction[a];
      if (at > 0 && at < length) ends.push_back(at);
    }
  std::sort(ends.begin(), ends.end());
  return integrate_ray(
      [&](double at) {
        const Point3 x = ray.at(at);
        RaySample s = interpolated(smoke.gaussians, sources, x);
        if (s.extinction > 0 && smoke.residual) s.extinction += scene::density(*smoke.residual, x);
        s.extinction = smoke.extinction[0] * std::max(0.0, s.extinction);
        return s;
      },
      ends, 1e-13);
}

}  // namespace

Check read_march_single_scattering(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in);
  const double sigma_t = in["sigma_t"].number(), albedo = in["albedo"].number_in(0, 1), g = in["g"].number_in(-1, 1),
               end = in["t_max"].number_in(0, 1e6);
  const crm::SourceLight light = environment_of(in);
  const std::vector<Ray> rays = rays_of(in["rays"]);
  const bool behind = in["background"].text() == "environment radiance in the ray direction";
  if (!behind && in["background"].text() != "none") in["background"].complain("none, or the environment");
  const std::vector<double> passed = expected["transmittance"].numbers(), radiance = expected["radiance"].numbers(),
                            between = expected["radiance_interpolated"].numbers();
  const OwnTolerance t = tolerance_of(v);
  return {
      "",
      [=](VerifyProfile) {
        const crm::SourceRadiance exact(smoke, Rgb::Constant(sigma_t), Rgb::Constant(albedo), powers_of(g), light,
                                        crm::Transmittance::directional,
                                        crm::ordinate_directions(levels_at_a_point, 2 * levels_at_a_point, false));
        std::vector<std::vector<Rgb>> centres;
        for (const scene::Gaussian& one : smoke.gaussians) centres.push_back(exact.at(one.center));
        const scene::PhaseFunction phase = scene::HenyeyGreenstein{g};
        std::vector<double> transmittances, direct, interpolation;
        for (const Ray& ray : rays) {
          const std::vector<double> ends = crossings(smoke, ray, 0, end);
          const RayIntegral full = integrate_ray(
              [&](double at) {
                const Point3 x = ray.at(at);
                const double density = scene::density(smoke, x);
                if (!(density > 0)) return RaySample{0, 0};
                double sent = 0;
                for (const LeftOfLight& l : light_left(smoke, sigma_t, light.harmonics, x, levels_on_a_ray))
                  sent += albedo * l.weight * l.radiance * l.transmittance *
                          phase_value(phase, l.toward.dot(ray.direction));
                return RaySample{sigma_t * density, sent};
              },
              ends, 1e-6);
          const std::vector<Vec3> out{-ray.direction};
          std::vector<double> sources;
          for (const std::vector<Rgb>& c : centres) sources.push_back(evaluated(c, out)[0]);
          const RayIntegral coarse = integrate_ray(
              [&](double at) {
                RaySample s = interpolated(smoke, sources, ray.at(at));
                s.extinction *= sigma_t;
                return s;
              },
              ends, 1e-11);
          const double left = std::exp(-sigma_t * density_integral(smoke, ray, {0, end}));
          const double beyond = behind ? left * scene::evaluate_sh(light.harmonics, ray.direction)[0] : 0;
          transmittances.push_back(left);
          direct.push_back(full.radiance + beyond);
          interpolation.push_back(coarse.radiance + beyond);
        }
        Outcome o;
        compare_all(o, "transmittance", passed, transmittances, t);
        compare_all(o, "radiance", radiance, direct, t);
        compare_all(o, "interpolated", between, interpolation, t);
        return o;
      },
      // Nodes half and a quarter of a width apart, between which sources are interpolated: of second order.
      [=](VerifyProfile) {
        const auto s = smoke_scene(smoke, sigma_t, albedo, g, light.harmonics);
        const char* layer = behind ? "mean" : "airlight";
        Outcome o;
        double worst[2] = {0, 0};
        for (const bool fine : {false, true}) {
          const Given given{{"cells", fine ? "24" : "12"}, {"levels", "12"}, {"slices", "1024"}, {"multiple", "none"}};
          const OneRay there(device_renderer, s, given), here(processor_renderer, s, given);
          for (std::size_t r = 0; r < rays.size(); ++r) {
            const scene::Film got = there(rays[r]);
            const double light_there = got.get(layer, 0, 0)[0];
            const std::string ray = fmt::format("{}ray {}", fine ? "fine, " : "coarse, ", r);
            o.add(relative(ray + " as the processor's", here(rays[r]).get(layer, 0, 0)[0], light_there, parity));
            o.add(relative(ray + " transmittance", passed[r], got.get("transmittance", 0, 0)[0], parity));
            if (fine) o.add(relative(ray + " radiance", radiance[r], light_there, 0.02));
            worst[fine] = std::max(worst[fine], std::abs(light_there / radiance[r] - 1));
          }
        }
        o.add(absolute("error of fine over coarse nodes", 0, worst[1] / worst[0], 0.35));
        return o;
      }};
}

Check read_march_compensated(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  crm::MarchedSmoke smoke;
  smoke.gaussians = gaussians_of(in);
  smoke.extinction = Rgb::Constant(in["sigma_t"].number() / unit);
  for (scene::Gaussian& g : smoke.gaussians.gaussians) g.amplitude *= unit;
  const Value sources = in["source_sh_propagation"];
  if (sources.size() == 0) sources.complain("a source for every Gaussian, at least one");
  for (std::size_t i = 0; i < sources.size(); ++i) smoke.source.push_back(grey_harmonics(sources[i]));
  if (in.has("residual")) smoke.residual = residual_of(in["residual"]["values_x_y_z"]);
  const std::vector<Ray> rays = rays_of(in["rays"]);
  const crm::Slices slices{in["slice_axis"].vector().normalized(), in["slice_thickness"].number_in(1e-6, 1e6),
                           in["slices"].integer_in(1, 1 << 20)};
  const double background = in["background"].number();
  const std::vector<std::string> names{"transmittance", "radiance",    "slice_transmittance",
                                       "slice_printed", "slice_paper", "slice_exact_weight"};
  std::vector<std::vector<double>> numbers;
  for (const std::string& name : names) {
    numbers.push_back(expected[name].numbers());
    if (numbers.back().size() != rays.size()) expected[name].complain("one for every ray");
  }
  const OwnTolerance t = tolerance_of(v);
  const crm::SliceWeight weights[]{crm::SliceWeight::exact, crm::SliceWeight::printed, crm::SliceWeight::paper,
                                   crm::SliceWeight::exact};
  // Marches with each weight; the results stand behind those of the integral.
  const auto add_slices = [=](const auto& march, const Ray& ray, std::vector<std::vector<double>>& got) {
    for (std::size_t w = 0; w < 4; ++w) {
      const crm::Marched m = march.slices(ray, slices, weights[w]);
      got[w + 2].push_back(m.transmittance[0] * (w == 0 ? 1 : background) + (w == 0 ? 0 : m.radiance[0]));
    }
  };
  Check check{"", [=](VerifyProfile) {
                const crm::CompensatedMarch march(smoke);
                std::vector<std::vector<double>> got(names.size());
                for (const Ray& ray : rays) {
                  std::vector<double> towards;
                  for (const std::vector<Rgb>& one : smoke.source)
                    towards.push_back(scene::evaluate_sh(one, -ray.direction)[0]);
                  const double length = slices.count * slices.thickness / std::abs(ray.direction.dot(slices.axis));
                  const RayIntegral exact = march_integral(smoke, towards, ray, length);
                  got[0].push_back(std::exp(-exact.depth));
                  got[1].push_back(exact.radiance + background * got[0].back());
                  add_slices(march, ray, got);
                }
                Outcome o;
                for (std::size_t i = 0; i < names.size(); ++i) compare_all(o, names[i], numbers[i], got[i], t);
                return o;
              }};
  if (smoke.residual) {
    check.not_on_device = "the device knows the sum of a residual and Gaussians at voxels alone";
    return check;
  }
  check.on_device = [=](VerifyProfile) {
    crm::MarchedSmoke in_metres = smoke;
    in_metres.extinction *= unit;
    for (scene::Gaussian& g : in_metres.gaussians.gaussians) g.amplitude /= unit;
    const CentreMarch march(in_metres);
    const crm::CompensatedMarch processor(in_metres);
    // `variant = grid` knows the same transmittance.
    const OneRay grid(device_renderer, smoke_scene(in_metres.gaussians, in_metres.extinction[0]),
                      {{"cells", "4"}, {"slices", "1024"}, {"multiple", "none"}});
    std::vector<std::vector<double>> got(names.size()), by_grid(1);
    Outcome o;
    for (const Ray& ray : rays) {
      const crm::Slices fine{slices.axis, slices.thickness / 16, 16 * slices.count};
      const crm::Marched limit = march.slices(ray, fine, crm::SliceWeight::exact);
      got[0].push_back(limit.transmittance[0]);
      got[1].push_back(limit.radiance[0] + background * limit.transmittance[0]);
      add_slices(march, ray, got);
      by_grid[0].push_back(grid(ray).get("transmittance", 0, 0)[0]);
      for (std::size_t w = 1; w < 4; ++w) {
        const crm::Marched here = march.slices(ray, slices, weights[w]),
                           there = processor.slices(ray, slices, weights[w]);
        const OwnTolerance close{1e-5, 2 * gpu::injected_error()};
        compare_all(o, "as the processor's", {there.radiance[0], there.transmittance[0]},
                    {here.radiance[0], here.transmittance[0]}, close);
      }
    }
    for (std::size_t i = 0; i < names.size(); ++i) compare_all(o, names[i], numbers[i], got[i], {parity, 0});
    compare_all(o, "transmittance, variant = grid", numbers[0], by_grid[0], {parity, 0});
    return o;
  };
  return check;
}

Check read_ray_march_homogeneous(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  crm::MarchedSmoke smoke;
  smoke.extinction = Rgb::Constant(in["sigma_t"].number());
  // A Gaussian so wide that it is even over the ray.
  smoke.gaussians.gaussians = {{Point3::Zero(), 1e9, in["D"].number()}};
  const double density = in["D"].number(), J = in["J"].number();
  smoke.source = {{Rgb::Constant(J * std::sqrt(4 * pi))}};
  const crm::Slices slices{Vec3::UnitZ(), in["step"].number_in(1e-6, 1e6), in["slices"].integer_in(1, 1 << 20)};
  const double passed = expected["transmittance"].number(), paper = expected["paper_sum_without_background"].number(),
               exact = expected["exact_without_background"].number();
  const OwnTolerance t = tolerance_of(v);
  const auto compare_sums = [=](const auto& march, const OwnTolerance& t_passed, const OwnTolerance& t) {
    const crm::Marched m = march(crm::SliceWeight::exact), p = march(crm::SliceWeight::paper);
    return Outcome{{compare("transmittance", passed, m.transmittance[0], t_passed),
                    compare("transmittance, paper", passed, p.transmittance[0], t_passed),
                    compare("paper", paper, p.radiance[0], t), compare("exact", exact, m.radiance[0], t)}};
  };
  return {
      "",
      [=](VerifyProfile) {
        const crm::CompensatedMarch march(smoke);
        const auto weighted = [&](crm::SliceWeight weight) {
          return march.slices({Point3::Zero(), Vec3::UnitZ()}, slices, weight);
        };
        return compare_sums(weighted, t, t);
      },
      // The smoke of `variant = grid` is one voxel here.
      [=](VerifyProfile) {
        gpu::Context& context = gpu::Context::get();
        const double length = slices.thickness * slices.count;
        scene::VoxelGrid grid;
        grid.size = Eigen::Vector3i::Ones();
        grid.voxel_size = length;
        grid.values = {float(density)};
        grid.clamp_border = true;
        scene::Medium medium;
        medium.field = std::make_shared<const scene::VoxelGrid>(grid);
        medium.sigma_t = smoke.extinction;
        const crm::SmokeField field(medium, {});
        const on::SmokeDensity voxel(context, field, Point3::Zero(), false);
        const scene::View view{camera_along({0, 0, 2 * length}, -Vec3::UnitZ()), 1, 1};
        const gpu::Buffer ranges(context, "ranges", 16), airlight(context, "airlight", 12),
            column(context, "column", 4), logarithms(context, "logarithms", std::vector<float>(4, float(std::log(J))));
        gpu::Program& find = on::program(context, "ranges", 8, 8, voxel.definitions());
        ranges.bind(on::at::ranges);
        airlight.bind(on::at::airlight_layer);
        column.bind(on::at::column);
        ranges.bind(on::at::distances);
        gpu::set_camera(find, view);
        voxel.bind(find);
        find.set("has_ends", false);
        find.set("slice", slices.thickness * (1 + 1e-6));  // the length is a whole number of them but for its rounding
        find.set("widths2", voxel.widths2());
        find.dispatch(1, 1);
        const auto weighted = [&](crm::SliceWeight weight) {
          return march_on_device(voxel, medium.sigma_t, view, Point3::Zero(), ranges, weight, [&](gpu::Program& p) {
            logarithms.bind(on::at::logarithms);
            p.set("corner", Vec3(Vec3::Constant(-0.5 * length)));
            p.set("cell_edge", length);
            p.set("brightest", Rgb(Rgb::Constant(1e37)));
            p.set("cells_along", Vec3(Vec3::Ones()));
          });
        };
        // A hundred sums, of which each is rounded to 2^-24 of the whole; depths of as many 2^-24 in the exponential.
        const double rounding = 100 * std::exp2(-24) + 2 * gpu::injected_error();
        Outcome o = compare_sums(weighted, {(1 - std::log(passed)) * rounding, 0}, {2 * rounding, 0});
        o.add(absolute("slices found", slices.count, ranges.download<float>()[2], 0));
        return o;
      }};
}

}  // namespace airlight::experiments::verification
