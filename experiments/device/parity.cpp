#include "experiments/device/parity.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/application/renderers.h"
#include "experiments/application/solvers.h"
#include "experiments/device/film_difference.h"
#include "experiments/device/small_scenes.h"
#include "gpu/context.h"
#include "scene/base/stopwatch.h"
#include "scene/flow/flow.h"

namespace airlight::experiments {
namespace {

using Given = std::map<std::string, std::string>;

const std::string name_of_check = "doctor --check";  // begins messages

// A figure, its tolerance, and what it is a figure of.
struct Figure {
  double error, tolerance;
  std::string what;
};

// A variant of the renderer METHOD and of its twin METHOD_gpu. Tolerances are those of the tests in tests/gpu/METHOD, for the difference
// of 99 % of a layer's values and for the worst value.
struct PictureCase {
  const char* method;
  Given settings;
  small::ScenePointer (*scene)();
  double of_99_percent, worst;
};

const std::vector<PictureCase>& picture_cases() {
  static const std::vector<PictureCase> cases{
      {"ray_marcher", {{"steps", "24"}, {"shadow_steps", "12"}}, small::smoke_in_room, 2.5e-5, 1.8e-4},
      {"half_resolution_march",
       {{"steps", "8"}, {"map_size", "32"}, {"map_steps", "32"}},
       small::smoke_in_room,
       1.5e-5,
       5.4e-5},
      {"froxel_fog", {{"tile", "4"}, {"map_size", "40"}, {"map_steps", "50"}}, small::smoke_in_room, 2.7e-5, infinity},
      {"fogshop", {{"variant", "S"}, {"K", "24"}, {"erf", "erf10"}}, small::haze_in_room, 3.3e-5, 2.2e-4},
      {"fogshop", {{"variant", "paper"}, {"erf", "erf10"}}, small::haze_in_room, 3.3e-5, 2.2e-4},
      {"shadow_planes", {}, small::shadow_of_box, 2.5e-6, 1e-5},
      {"shadow_planes", {{"shadows", "stencil"}, {"evaluation", "vertices"}}, small::shadow_of_box, 2.5e-6, 1e-5},
      {"wavelet_fog", {{"variant", "direct"}}, small::map_of_fog, 2e-6, infinity},
      {"wavelet_fog", {{"variant", "tele"}, {"mu", "0.4"}}, small::map_of_fog, 1e-5, infinity},
      {"legendre_fluids", {{"variant", "ray"}}, small::polynomial_of_smoke, 3e-6, 3e-6},
      // The tests allow a millionth of the greatest value: 1e-4 of the values that are least beside the 1 % in the difference.
      {"legendre_fluids", {{"variant", "paper"}, {"n", "4"}}, small::polynomial_of_smoke, 1e-4, 1e-4},
      {"compensated_ray_marching",
       {{"variant", "grid"}, {"cells", "12"}, {"tolerance", "1e-5"}, {"levels", "6"}},
       small::smoke_under_sky,
       5e-5,
       5e-5},
      {"compensated_ray_marching", {{"variant", "paper"}, {"iterations", "12"}}, small::smoke_under_sky, 5e-5, 5e-5},
  };
  return cases;
}

// Bound on the difference over the greatest value, as after 40 steps in tests/gpu/legendre_fluids/flow_test.cpp.
constexpr double flow_tolerance = 2e-5;
const Given flow_settings{{"n", "6"}, {"filter_velocity", "0.5"}, {"filter_carried", "1"}};

std::string text(const Given& settings) {
  std::string all;
  for (const auto& [name, value] : settings) all += (all.empty() ? "" : ", ") + name + " = " + value;
  return all;
}

scene::Film picture(const scene::Renderer& renderer, const PictureCase& c, const scene::Execution& execution) {
  const small::ScenePointer scene = c.scene();
  const auto prepared = renderer.prepare(scene, {renderer.settings(), c.settings, name_of_check}, execution);
  return prepared->render(view_of(*scene), execution).film;
}

std::vector<Figure> compare(const PictureCase& c, const scene::Execution& execution) {
  const std::string name = c.method;
  const scene::Film truth = picture(find_renderer(name, name_of_check), c, execution),
                    film = picture(find_renderer(name + "_gpu", name_of_check), c, execution);
  std::vector<Figure> figures;
  for (const auto& [layer, values] : truth.layers) {
    figures.push_back(
        {difference_quantile(truth, film, layer, 0.99), c.of_99_percent, layer + " (99 % of the values)"});
    if (c.worst < infinity)
      figures.push_back({difference_quantile(truth, film, layer, 1), c.worst, layer + " (worst value)"});
  }
  return figures;
}

std::vector<Figure> compare_flows(const scene::Execution& execution) {
  const auto problem = small::warm_swirl();
  const auto start = [&](const char* name) {
    const scene::Solver& solver = find_solver(name, name_of_check);
    return solver.start(problem, {solver.settings(), flow_settings, name_of_check}, execution);
  };
  const std::unique_ptr<scene::Flow> truth = start("legendre_fluids"), flow = start("legendre_fluids_gpu");
  for (int step = 0; step < 10; ++step) truth->step(0.02), flow->step(0.02);
  Vec3 off = Vec3::Zero(), most = Vec3::Constant(1e-300);
  for (int i = 0; i < 125; ++i) {
    const Point3 x = problem->box.lo + Vec3(i % 5, i / 5 % 5, i / 25).cwiseProduct(problem->box.size()) / 4;
    const Vec3 u = truth->velocity(x);
    const Vec3 values(u.norm(), std::abs(truth->density(x)), std::abs(truth->temperature(x)));
    const Vec3 differences((flow->velocity(x) - u).norm(), std::abs(flow->density(x) - truth->density(x)),
                           std::abs(flow->temperature(x) - truth->temperature(x)));
    if (!differences.allFinite()) off = Vec3::Constant(infinity);
    most = most.cwiseMax(values);
    off = off.cwiseMax(differences);
  }
  std::vector<Figure> figures;
  const char* const names[] = {"velocity", "density", "temperature"};
  for (int k = 0; k < 3; ++k)
    figures.push_back({off[k] / most[k], flow_tolerance, fmt::format("{} after 10 steps", names[k])});
  return figures;
}

Parity judged(Parity parity, const std::function<std::vector<Figure>()>& compare) {
  scene::Stopwatch watch;
  try {
    const std::vector<Figure> figures = compare();
    const Figure& worst = *std::max_element(figures.begin(), figures.end(), [](const Figure& a, const Figure& b) {
      return a.error / a.tolerance < b.error / b.tolerance;
    });
    parity.error = worst.error, parity.tolerance = worst.tolerance, parity.measured = worst.what;
  } catch (const NoDevice&) {
    throw;
  } catch (const Unavailable& reason) {
    parity.unavailable = reason.what();
  } catch (const Error& error) {
    parity.failure = error.what();
  }
  parity.seconds = watch.lap();
  return parity;
}

}  // namespace

std::string finding(const Parity& p) {
  if (!p.failure.empty()) return p.failure;
  if (!p.unavailable.empty()) return p.unavailable;
  return fmt::format("{} differs by {:.2g} from the CPU, tolerance {:.2g}", p.measured, p.error, p.tolerance);
}

std::vector<Parity> check_parity(const scene::Execution& execution, const std::function<void(const Parity&)>& done) {
  gpu::Context::get();
  std::vector<Parity> all;
  // Progress is that of all comparisons.
  scene::Execution part = execution;
  if (execution.progress)
    part.progress = [&](double) { return execution.progress(double(all.size()) / double(picture_cases().size() + 1)); };
  const auto add = [&](Parity parity, const std::function<std::vector<Figure>()>& compare) {
    all.push_back(judged(std::move(parity), compare));
    done(all.back());
  };
  for (const PictureCase& c : picture_cases()) {
    Parity parity;
    parity.method = std::string(c.method) + "_gpu";
    parity.settings = text(c.settings);
    add(parity, [&] { return compare(c, part); });
  }
  Parity flow;
  flow.method = "legendre_fluids_gpu";
  flow.computes = Computes::flows;
  flow.settings = text(flow_settings);
  add(flow, [&] { return compare_flows(part); });
  return all;
}

}  // namespace airlight::experiments
