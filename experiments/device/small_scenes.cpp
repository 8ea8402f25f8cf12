#include "experiments/device/small_scenes.h"

#include <cmath>

#include "scene/geometry/shapes.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"

namespace airlight::experiments::small {
namespace {

scene::Medium medium(scene::DensityField field, const Rgb& sigma_t) {
  scene::Medium made;
  made.field = std::move(field);
  made.sigma_t = sigma_t;
  made.albedo = Rgb(0.9, 0.8, 0.7);
  return made;
}

// A lamp over a box on a floor, around the origin. The film is no multiple of a tile.
scene::Scene room(scene::Medium fog) {
  scene::Scene scene;
  scene.name = "small scene";
  scene.width = 29, scene.height = 21;
  scene.camera = scene::look_at({0.4, 0.5, 3}, {0, 0, 0}, Vec3::UnitY());
  scene.camera.vertical_fov = 0.8;
  scene.lights = {scene::PointLight{{0.5, 1.6, 0.8}, Rgb(9, 8, 7), 0}};
  scene.media = {std::move(fog)};
  scene.surfaces = {{"floor", scene::Plane{{0, -0.8, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.7, 0.6, 0.5)}},
                    {"box", scene::make_box({{-0.2, -0.5, -0.4}, {0.3, -0.1, 0.1}}), scene::Lambert{}}};
  return scene;
}

scene::GaussianSum puffs() {
  scene::GaussianSum sum;
  sum.gaussians = {{{0, 0, 0}, 0.4, 1}, {{0.5, 0.2, -0.1}, 0.25, 0.7}, {{-0.3, 0.4, 0.2}, 0.3, 0.9}};
  return sum;
}

ScenePointer finished(scene::Scene scene) {
  finish(scene);
  return std::make_shared<const scene::Scene>(std::move(scene));
}

}  // namespace

ScenePointer smoke_in_room() { return finished(room(medium(puffs(), Rgb(2, 3, 4)))); }

ScenePointer haze_in_room() {
  scene::GaussianSum sum = puffs();
  sum.constant = 0.1;
  scene::Medium fog = medium(std::move(sum), Rgb::Constant(0.8));
  fog.albedo = Rgb::Constant(0.9);
  return finished(room(std::move(fog)));
}

ScenePointer shadow_of_box() { return finished(room(medium(scene::Homogeneous{1}, Rgb(0.1, 0.2, 0.4)))); }

ScenePointer smoke_under_sky() {
  scene::GaussianSum sum = puffs();
  sum.cutoff = 3;
  scene::Scene scene = room(medium(std::move(sum), Rgb::Constant(4)));
  scene.media[0].albedo = Rgb::Constant(0.9);
  scene.surfaces.pop_back();  // the box
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  scene.lights = {scene::make_sh_environment(
      {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5, 0), Rgb(0, -0.5 * slope, 0.4)}, Mat3::Identity(),
      Rgb::Ones())};
  return finished(std::move(scene));
}

ScenePointer map_of_fog() {
  const int width = 40, height = 33, degree = 2;
  std::vector<double> values;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) values.push_back(std::max(0.0, std::sin(0.23 * i + 3) * std::sin(0.19 * j + 6)));
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(degree, {{0, 0}, {width, height}}, values);
  fog->profile = scene::ExponentialFall{0.5, 2.5};
  fog->x0 = -0.5 * (width + degree), fog->z0 = -0.5 * (height + degree);
  scene::Scene scene = room(medium(scene::FogmapPointer(std::move(fog)), 0.15 * Rgb(0.9, 1, 1.1)));
  scene.camera = scene::look_at({-12, 2, -22}, {3, 1.5, 8}, Vec3::UnitY());
  scene.camera.vertical_fov = 0.9;
  scene.lights = {scene::PointLight{{-4, 2, -6}, Rgb(40, 30, 20), 0}};
  scene.ambient_in_scatter = Rgb(0.6, 0.7, 0.8);
  return finished(std::move(scene));
}

ScenePointer polynomial_of_smoke() {
  const int n = 4;
  Eigen::VectorXd coefficients(n * n * n);
  for (int i = 0; i < n * n * n; ++i)
    coefficients[i] = 0.15 * std::sin(1.7 * i) * std::pow(1.0 + i / (n * n) + i / n % n + i % n, -2);
  coefficients[0] = std::sqrt(8.0);  // mean 1
  const Box box{Point3::Constant(-1), Point3::Constant(1)};
  scene::Scene scene = room(medium(
      std::make_shared<const scene::LegendreBox>(box, scene::TensorShape{n, n, n}, coefficients), Rgb::Constant(1)));
  scene.media[0].albedo = Rgb::Constant(0.8);
  scene.surfaces.clear();
  scene.lights = {scene::DirectionalLight{Vec3(-0.48, -0.6, 0.64), Rgb::Ones()}};
  scene.camera = scene::look_at({-1.8, 2.4, 4}, Point3::Zero(), Vec3::UnitY());
  scene.camera.kind = scene::Camera::Kind::orthographic;
  scene.camera.height = 2.6;
  scene.width = 14, scene.height = 11;
  return finished(std::move(scene));
}

std::shared_ptr<const scene::FlowProblem> warm_swirl() {
  auto problem = std::make_shared<scene::FlowProblem>();
  problem->name = "small flow";
  problem->box = {{1, 2, 0}, {2, 3.5, 0.75}};
  const Point3 middle = problem->box.center();
  problem->velocity = scene::Swirl{0.5};
  problem->gravity = Vec3(2, -9.81, 1);
  problem->expansion = 1.0 / 300;
  problem->weight = 0.02;
  problem->viscosity = 1e-3, problem->diffusivity = 5e-4, problem->decay = 0.3;
  problem->blobs.push_back({middle - Vec3(0.1, 0.3, 0), 0.3, 1, 30});
  scene::Source source;
  source.region = Box{middle - Vec3(0.3, 0.6, 0.3), middle + Vec3(0.3, 0, 0.3)};
  source.density_rate = 2, source.temperature_rate = 40;
  problem->sources.push_back(source);
  problem->hash = content_hash(*problem);
  return problem;
}

}  // namespace airlight::experiments::small
