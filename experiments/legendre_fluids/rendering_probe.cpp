#include "experiments/legendre_fluids/rendering_probe.h"

#include <fmt/format.h>

#include <algorithm>

#include "methods/legendre_fluids/light.h"
#include "reference/deterministic/renderer.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/legendre_projection.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments {
namespace {

enum class How { ray, paper, upwind, grid };
const scene::Choices<How> ways{{"ray", How::ray}, {"paper", How::paper}, {"upwind", How::upwind}, {"grid", How::grid}};
using Given = std::map<std::string, std::string>;

// Smoke to render. In two dimensions it does not depend on z: a thin slice, seen in its plane.
struct Smoke {
  int dimensions;
  double depth;  // of the box where it is thickest, about
  int width;     // of the film
  double softness;

  double half(int axis) const { return axis < dimensions ? 1 : 1e-4; }
  Box box() const { return {{-1, -1, -half(2)}, {1, 1, half(2)}}; }
  scene::GaussianSum density() const {
    scene::GaussianSum sum;
    sum.constant = 0.1;
    const double z = dimensions == 3 ? 1 : 0;
    sum.gaussians = {
        {{-0.3, -0.4, 0.2 * z}, 0.5, 0.8}, {{0.35, 0.1, -0.3 * z}, 0.45, 0.9}, {{-0.1, 0.55, 0.1 * z}, 0.4, 0.7}};
    for (scene::Gaussian& g : sum.gaussians) g.width *= softness;
    return sum;
  }
  std::shared_ptr<scene::Scene> scene(scene::Medium medium) const {
    auto scene = std::make_shared<scene::Scene>();
    scene->name = "smoke";
    medium.sigma_t = Rgb::Constant(0.5 * depth);
    medium.albedo = Rgb::Constant(0.8);
    scene->media = {std::move(medium)};
    const bool flat = dimensions == 2;
    scene->lights = {scene::DirectionalLight{flat ? Vec3(-0.6, 0.8, 0) : Vec3(-0.48, -0.6, 0.64), Rgb::Ones()}};
    const Vec3 view = flat ? Vec3(0.8, 0.6, 0) : Vec3(0.36, -0.48, -0.8);
    scene->camera = scene::look_at(-5 * view, Point3::Zero(), flat ? Vec3::UnitZ() : Vec3::UnitY());
    scene->camera.kind = scene::Camera::Kind::orthographic;
    scene->width = width;
    scene->height = flat ? 1 : width * 3 / 4;
    scene->camera.height = flat ? 2.9 / width : 2.9;
    finish(*scene);
    return scene;
  }
  scene::Medium exact() const {
    scene::Medium medium;
    medium.field = density();
    medium.region = box();
    return medium;
  }
  scene::Medium coefficients(int n) const {
    scene::ProjectionOptions options;
    options.shape = {n, n, dimensions == 3 ? n : 1};
    options.box = box();
    options.lanczos = false;
    scene::Medium medium;
    medium.field = project_to_legendre(exact(), options).field;
    return medium;
  }
  // Samples in the middle of n cells along an axis.
  scene::Medium voxels(int n) const {
    auto grid = std::make_shared<scene::VoxelGrid>();
    grid->size = {n, n, dimensions == 3 ? n : 1};
    grid->voxel_size = 2. / n;
    for (int a = 0; a < dimensions; ++a) grid->translation[a] = -1 + 0.5 * grid->voxel_size;
    grid->clamp_border = true;
    const scene::GaussianSum sum = density();
    for (int k = 0; k < grid->size[2]; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          grid->values.push_back(float(scene::density(sum, sample_to_world(*grid, Point3(i, j, k)))));
    scene::Medium medium;
    medium.field = scene::GridPointer(grid);
    return medium;
  }
};

struct Picture {
  scene::Film film;
  std::vector<double> seconds;  // of all that a new density takes: preparation and picture
};

Picture made(const scene::Renderer& renderer, const std::shared_ptr<scene::Scene>& scene, const Given& given, int runs,
             const scene::Execution& execution) {
  const scene::Settings settings(renderer.settings(), given);
  Picture picture;
  scene::Stopwatch watch;
  for (int run = 0; run <= runs; ++run) {
    watch.lap();
    picture.film = renderer.prepare(scene, settings, execution)->render(view_of(*scene), execution).film;
    if (run > 0) picture.seconds.push_back(watch.lap());
  }
  return picture;
}

// Steps of a voxel, along rays and towards the light.
Picture of_grid(const Smoke& smoke, int n, int runs, const scene::Execution& execution) {
  return made(ray_marcher::RayMarcher(), smoke.scene(smoke.voxels(n)), {{"step", "1"}, {"shadow_step", "1"}}, runs,
              execution);
}

double error_of(const scene::Film& film, const scene::Film& truth) {
  const auto &a = film.layer("airlight"), &b = truth.layer("airlight");
  double off = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    off += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
    norm += double(b[i]) * b[i];
  }
  return std::sqrt(off / norm);
}

std::vector<int> grids_of(int dimensions) {
  return dimensions == 2 ? std::vector<int>{64, 128, 256, 512} : std::vector<int>{16, 32, 64, 96};
}

}  // namespace

std::string LegendreRendering::about() const {
  return "time and error of a picture of smoke as Legendre coefficients, and how many times faster that is than its voxels";
}

std::vector<scene::SettingSpec> LegendreRendering::settings() const {
  return {scene::choice_setting("how", How::ray, ways,
                                "variants and closures of legendre_fluids; grid: the ray marcher in voxels"),
          scene::integer_setting("size", "4", 1, 512, "coefficients, or voxels, along an axis"),
          scene::integer_setting("dimensions", "3", 2, 3, "2: the same for all z, a film of one row"),
          scene::real_setting("depth", "4", 1e-6, 1e4, "about the optical depth of the box where it is thickest"),
          scene::real_setting("softness", "1", 0.1, 10, "times the widths of the three blobs, about half of the box's"),
          scene::integer_setting("width", "64", 4, 4096, "of the film, pixels"),
          scene::integer_setting("runs", "5", 1, 1000, "timed pictures, each with its preparation")};
}

std::vector<std::string> LegendreRendering::figures() const {
  std::vector<std::string> names = speeds();
  names.insert(names.begin(), "error");
  return names;
}

std::vector<std::string> LegendreRendering::speeds() const {
  std::vector<std::string> names;
  for (const int dimensions : {2, 3})
    for (const int n : grids_of(dimensions)) names.push_back(fmt::format("faster_{}d_{}", dimensions, n));
  return names;
}

Findings LegendreRendering::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  const Smoke smoke{int(s.integer("dimensions")), s.real("depth"), int(s.integer("width")), s.real("softness")};
  const How how = s.choice("how", ways);
  const int size = int(s.integer("size")), runs = int(s.integer("runs"));
  if (how != How::grid && size > scene::LegendreBox::most)
    throw Error(fmt::format("size = {} coefficients, expected at most {}", size, scene::LegendreBox::most));
  const scene::Film truth =
      made(*deterministic::make_renderer(), smoke.scene(smoke.exact()), {{"relative_tolerance", "1e-6"}}, 0, execution)
          .film;
  Findings found;
  Picture picture;
  if (how == How::grid) {
    picture = of_grid(smoke, size, runs, execution);
  } else {
    const Given given[] = {{},
                           {{"variant", "paper"}, {"n", std::to_string(size)}},
                           {{"variant", "paper"}, {"n", std::to_string(size)}, {"closure", "upwind"}}};
    picture = made(airlight::legendre_fluids::LegendreLight(), smoke.scene(smoke.coefficients(size)), given[int(how)],
                   runs, execution);
    for (const int n : grids_of(smoke.dimensions)) {
      std::vector<double> ratio = of_grid(smoke, n, runs, execution).seconds;
      for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] /= picture.seconds[i];
      found.figures.push_back(measured(fmt::format("faster_{}d_{}", smoke.dimensions, n), ratio));
    }
  }
  found.figures.push_back(exactly("error", error_of(picture.film, truth)));
  found.counters["unknowns"] = std::pow(size, smoke.dimensions);
  set_time(found, picture.seconds);
  return found;
}

}  // namespace airlight::experiments
