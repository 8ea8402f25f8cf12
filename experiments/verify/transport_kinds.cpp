// Zhou et al. 2008: light that was scattered any number of times, by diffusion and by the transport equation, in slabs, half spaces and a
// ball. The device solves diffusion. The method's solvers meet these vectors to a part in 100 or 1,000, as their tests say, and no renderer to the vectors' own accuracy:
// tests/second_opinion has solvers that do.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_on_device.h"
#include "experiments/verify/smoke_vector.h"
#include "gpu/compensated_ray_marching/p1_grid.h"
#include "methods/compensated_ray_marching/diffusion_system.h"

namespace airlight::experiments::verification {
namespace {

constexpr double most_albedo = 1 - 1e-9;
constexpr double of_floats = 1e-6;  // relative, of sources in single precision that are differences of others

double relative_distance(const std::vector<double>& got, const std::vector<double>& expected) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error += std::pow(got.at(i) - expected[i], 2);
    size += expected[i] * expected[i];
  }
  return std::sqrt(error / size);
}

// Smoke of density 1 that scatters.
on::Scatterer scatterer_of(const Value& in) {
  return {in["sigma_t"].number_in(1e-6, 1e6), in["albedo"].number_in(1e-3, most_albedo),
          in["g"].number_in(-0.99, 0.99)};
}

// Mean radiance that has been scattered in each cell, by diffusion on the device, for a source without a direction.
class Diffused {
 public:
  Diffused(const crm::OrdinateGrid& grid, const on::Scatterer& s, const std::vector<double>& mean_source,
           double tolerance = 1e-12)
      : grid_(grid), s_(s) {
    gpu::Context& context = gpu::Context::get();
    const std::size_t cells = mean_source.size();
    std::vector<float> single(cells);
    for (std::size_t i = 0; i < cells; ++i) single[i] = float(mean_scale * mean_source[i]);
    const gpu::Buffer densities(context, "densities", std::vector<float>(cells, 1.0F)), once(context, "source", single),
        result(context, "result", 4 * cells);
    on::P1GridOnDevice(context, grid, densities, s, 1, 1, {tolerance, 100000}).solve(once, result, 0, {1, {}});
    const std::vector<float> all = result.download<float>();
    for (std::size_t i = 0; i < cells; ++i)
      values_.push_back((double(all[i]) - double(single[i])) / (s.albedo * mean_scale));
  }
  double operator[](int cell) const { return values_.at(std::size_t(cell)); }
  // At the face at which a cell ends: Marshak's condition, half of it is what flows out.
  double at_face(int cell, int axis) const {
    const double half_cell = 0.5 * grid_.cell[axis] * 3 * (1 - s_.albedo * s_.mean_cosine) * s_.sigma_t;
    return (*this)[cell] * 2 / (half_cell + 2);
  }

 private:
  inline static const double mean_scale = std::sqrt(4 * pi);
  crm::OrdinateGrid grid_;
  on::Scatterer s_;
  std::vector<double> values_;
};

}  // namespace

Check read_without_renderer(const Value&) {
  Check check = no_renderer();
  check.not_on_device = "no renderer draws slabs and half spaces without end";
  return check;
}

// At distances of some cells. The box is so large that light from its faces is below the tolerance.
Check read_diffusion_point_source(const Value& v) {
  const Value in = v["input"];
  const on::Scatterer s = scatterer_of(in);
  const double distance = in["r"].number_in(1e-6, 1e6), power = in["power"].number(),
               expected = v["expected"]["mean_radiance"].number();
  Check check = no_renderer();
  check.on_device = [=](VerifyProfile) {
    const double faded = distance * std::sqrt(3 * (1 - s.albedo) * (1 - s.albedo * s.mean_cosine)) * s.sigma_t;
    const int away = std::max(6, int(std::ceil(faded / 0.22))), side = 2 * int(std::ceil(away * (1 + 3 / faded))) + 1;
    const double cell = distance / away;
    std::vector<double> source(std::size_t(side) * std::size_t(side) * std::size_t(side), 0.0);
    const int middle = side / 2 * (1 + side * (1 + side));
    source[std::size_t(middle)] = power / (4 * pi * s.sigma_t * cell * cell * cell);
    const Diffused got({{side, side, side}, Vec3::Constant(cell)}, s, source, 1e-6);
    return Outcome{{relative(fmt::format("{} cells away", away), expected, got[middle + away], 0.02)}};
  };
  return check;
}

// Between two grids, errors of second order taken off.
Check read_diffusion_slab(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  // Diffused has density 1, and no direction.
  if (in["D"].number() != 1 || in["J1"].number() != 0) return no_renderer();
  const on::Scatterer s = scatterer_of(in);
  const double thickness = in["thickness"].number_in(1e-6, 1e6), source = in["J0"].number();
  const std::array<double, 3> expected{e["centre"].number(), e["quarter"].number(), e["boundary"].number()};
  Check check = no_renderer();
  check.on_device = [=](VerifyProfile) {
    std::array<double, 3> found{};
    constexpr int coarse = 202, fine = 602;  // the middle of a cell is a quarter
    for (const int cells : {coarse, fine}) {
      const Diffused got({{1, 1, cells}, Vec3(1, 1, thickness / cells), {true, true, false}}, s,
                         std::vector<double>(std::size_t(cells), source));
      const double share = double(cells) * cells / (double(fine) * fine - double(coarse) * coarse);
      const std::array<double, 3> here{0.5 * (got[cells / 2 - 1] + got[cells / 2]), got[cells / 4], got.at_face(0, 2)};
      for (std::size_t i = 0; i < 3; ++i) found[i] += (cells == fine ? share : -share) * here[i];
    }
    Outcome o;
    const std::array<const char*, 3> names{"centre", "quarter", "boundary"};
    for (std::size_t i = 0; i < 3; ++i) o.add(relative(names[i], expected[i], found[i], of_floats));
    return o;
  };
  return check;
}

Check read_diffusion_uniform_source(const Value& v) {
  const Value in = v["input"];
  const double albedo = in["albedo"].number_in(0, most_albedo), source = in["single_scatter_mean_source"].number();
  const double expected = v["expected"].number();
  Check check{"", [=, t = tolerance_of(v)](VerifyProfile) {
                // The publication's box is closed: smoke in it is smoke without end.
                const crm::DiffusionSystem s =
                    crm::diffusion_system({{Point3::Zero(), 0.1, 0.7}}, {{source, Vec3::Zero()}}, 5, albedo, 0.3,
                                          crm::DiffusionForm::corrected);
                const double got =
                    crm::solve_least_squares(s, Eigen::VectorXd::Zero(1), 10, 1e-15, crm::LeastSquaresSolver::cg).x[0];
                Outcome o;
                o.add(compare("at a centre", expected, got, t));
                return o;
              }};
  check.on_device = [=](VerifyProfile) {
    constexpr int cells = 400;
    const Diffused got({{1, 1, cells}, Vec3::Ones(), {true, true, false}}, {5, albedo, 0.3},
                       std::vector<double>(cells, source));
    return Outcome{{relative("in the middle of a slab", expected, got[cells / 2], of_floats)}};
  };
  return check;
}

Check read_multiple_scattering_ball(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in);
  if (smoke.gaussians.size() != 1 || smoke.cutoff > 10) in.complain("one Gaussian, cut");
  if (in["phase"].text() != "order 4: P_l with l < 4") in["phase"].complain("order 4");
  const scene::Gaussian one = smoke.gaussians[0];
  const std::vector<double> radii = in["radius_over_r"].numbers(), impacts = in["impact_over_r"].numbers();
  std::array<std::vector<double>, 5> numbers;
  const std::array<const char*, 5> names{"mean_radiance", "mean_reduced_radiance", "mean_flux_moment", "exit_radiance",
                                         "exit_transmittance"};
  for (std::size_t i = 0; i < 5; ++i)
    if (i != 2 || expected.has(names[i])) numbers[i] = expected[names[i]].numbers();
  const double albedo = in["albedo"].number_in(0, 1), g = in["g"].number_in(-1, 1),
               radiance = in["environment_radiance"].number(), sigma_t = in["sigma_t"].number_in(0, 1e6);
  Check check = no_renderer();
  check.on_device = [=](VerifyProfile) {
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
        if (here) o.add(relative("exit, as the processor's", (*here)(ray).get("mean", 0, 0)[0], exits.back(), parity));
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
    // The smoke is 8 or 23 deep. Coarse cells are up to 2.2 or 6.4 deep, fine cells 0.75 or 2.1. An error of second
    // order falls to a ninth.
    const auto below = [&](const char* what, double error, double bound) { o.add(absolute(what, 0, error, bound)); };
    const auto below_coarse = [&](const char* what, const double* errors) {
      if (errors[0] > 0.01) below(what, errors[1] / errors[0], 0.2);
    };
    below("error of exit_radiance", exit_errors[1], albedo < 0.95 ? 0.003 : 0.01);
    below_coarse("error of fine over coarse, exit_radiance", exit_errors);
    if (!with_means) return o;
    below("error of mean_radiance", mean_errors[1], 0.01);
    below_coarse("error of fine over coarse, mean_radiance", mean_errors);
    return o;
  };
  return check;
}

}  // namespace airlight::experiments::verification
