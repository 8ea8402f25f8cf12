// Fogmaps and Legendre boxes in the marches of the device, alone and beside Gaussians: the pictures of the CPU.
#include <catch2/catch.hpp>

#include "gpu/froxel_fog/froxel_fog.h"
#include "gpu/half_resolution_march/half_resolution_march.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "reference/froxel_fog/froxel_fog.h"
#include "reference/half_resolution_march/half_resolution_march.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/wavelet_fog/pictures.h"

namespace series_test {

using namespace airlight;
using test::Given;
using ScenePointer = std::shared_ptr<scene::Scene>;

namespace {

// In a box, under a sun and a lamp, beside a puff of Gaussians if `beside`.
ScenePointer lit(scene::DensityField field, bool beside) {
  auto made = std::make_shared<scene::Scene>();
  made->name = "series";
  made->width = 24, made->height = 18;
  made->camera = scene::look_at({-5, 2.2, -6}, {0, 0.6, 0}, Vec3::UnitY());
  made->lights = {scene::DirectionalLight{Vec3(1, 2, 0.5).normalized(), Rgb(3, 2.8, 2.5)},
                  scene::PointLight{{-1, 3.5, -3}, Rgb(20, 25, 30), 0}};
  scene::Medium medium;
  medium.field = std::move(field);
  medium.region = Box{{-3, -0.5, -3.5}, {3.2, 2.5, 3}};
  medium.sigma_t = Rgb(2, 2.2, 2.4);
  medium.albedo = Rgb(0.9, 0.8, 0.7);
  made->media = {medium};
  if (beside) {
    scene::Medium puff;
    puff.field = scene::GaussianSum{{{{0.5, 1, -1}, 0.9, 1}, {{-1, 0.5, 0}, 0.7, 0.6}}, 0.05, infinity};
    puff.region = Box{{-4, -1, -4}, {4, 4, 4}};
    puff.sigma_t = Rgb::Constant(0.3);
    made->media.insert(made->media.begin(), puff);
  }
  finish(*made);
  return made;
}

ScenePointer map_of(int degree, const scene::HeightProfile& profile, bool beside, unsigned seed = 3) {
  auto fog = gpu::test::patches(degree, 20, 17, 0.4, seed, profile);
  fog->cos_turn = 0.8, fog->sin_turn = 0.6;
  fog->x0 = -5, fog->z0 = -1;
  return lit(scene::FogmapPointer(fog), beside);
}

ScenePointer box_of(bool beside) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const scene::TensorShape shape{4, 3, 5};
  Eigen::VectorXd coefficients(scene::tensor_size(shape));
  for (double& value : coefficients) value = 0.25 * uniform(random);
  coefficients[0] = 1;
  return lit(std::make_shared<const scene::LegendreBox>(Box{{-2.5, -0.4, -3}, {3, 2.2, 2.5}}, shape, coefficients),
             beside);
}

void agree(const scene::Renderer& processor, const scene::Renderer& device, const ScenePointer& scene,
           const Given& given, const std::string& name, double share = 0.99) {
  const Given read = scene::without_unread(processor.settings(), given);
  const scene::Rendering cpu = test::render(processor, scene, read), gpu = test::render(device, scene, read);
  for (const char* layer : {"airlight", "transmittance"}) {
    const double off = gpu::test::quantile(cpu.film, gpu.film, layer, share);
    CAPTURE(name, given, layer, off);
    CHECK(off < 2e-5 + 10 * gpu::test::injected_error());
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{} {}: {:.1e}\n", name, layer, off);
  }
  CHECK(*std::min_element(cpu.film.layer("transmittance").begin(), cpu.film.layer("transmittance").end()) < 0.8);
  for (const char* counter : {"steps", "shadow_steps"})
    if (cpu.counters.count(counter)) CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(2e-3));
}

const scene::HeightProfile profiles[] = {scene::SameAtAllHeights{}, scene::Layers{{-0.2, 0.8, 1.9}, {0.6, 1, 0}},
                                         scene::ExponentialFall{0.2, 0.7}};

void agree_in_all_marches(const ScenePointer& scene, const std::string& name, double share = 0.99) {
  const ray_marcher::RayMarcher marcher;
  const gpu::ray_marcher::RayMarcher gpu_marcher;
  agree(marcher, gpu_marcher, scene, {{"steps", "24"}, {"shadow_steps", "8"}}, name, share);
  agree(marcher, gpu_marcher, scene, {{"steps", "24"}, {"shadow", "map"}, {"map_size", "24"}, {"map_steps", "20"}},
        name + " map", share);
  agree(froxel_fog::FroxelFog(), gpu::froxel_fog::FroxelFog(), scene,
        {{"tile", "4"}, {"slices", "20"}, {"map_size", "24"}, {"map_steps", "20"}}, name + " froxels", share);
  agree(half_resolution_march::HalfResolutionMarch(), gpu::half_resolution_march::HalfResolutionMarch(), scene,
        {{"steps", "10"}, {"map_size", "24"}, {"map_steps", "20"}}, name + " half", share);
}

}  // namespace

DEVICE_TEST_CASE("marches of fogmaps on the device are those of the CPU", "[gpu][ray_marcher]") {
  for (int degree = 1; degree <= 3; ++degree)
    agree_in_all_marches(map_of(degree, profiles[degree - 1], degree == 2), fmt::format("map of degree {}", degree));
  // Steps beside an edge between cells fall to the other side.
  agree_in_all_marches(map_of(0, profiles[1], false), "map of degree 0", 0.8);
}

DEVICE_TEST_CASE("marches of Legendre boxes on the device are those of the CPU", "[gpu][ray_marcher]") {
  for (const bool beside : {false, true}) agree_in_all_marches(box_of(beside), beside ? "box beside Gaussians" : "box");
}

// Another map in the next frame, of another size too.
DEVICE_TEST_CASE("froxels: a next frame with another fogmap is the frame made anew", "[gpu][froxel_fog]") {
  const gpu::froxel_fog::FroxelFog method;
  const scene::Settings settings(method.settings(), {{"tile", "4"}, {"slices", "20"}, {"map_size", "24"}});
  const auto frames = method.prepare(map_of(2, profiles[1], true), settings, {1, {}});
  for (const ScenePointer& scene : {map_of(2, profiles[1], true, 8), map_of(1, profiles[2], true), box_of(true)}) {
    REQUIRE(frames->next(scene, {1, {}}));
    CHECK(frames->render(view_of(*scene), {1, {}}).film.layers ==
          method.prepare(scene, settings, {1, {}})->render(view_of(*scene), {1, {}}).film.layers);
  }
}

// Every degree with every profile. The box is negative in places.
DEVICE_TEST_CASE("ray marcher: exact shadows of fogmaps and Legendre boxes on the device", "[gpu][ray_marcher]") {
  const Given exact{{"steps", "24"}, {"shadow", "exact"}};
  const ray_marcher::RayMarcher marcher;
  const gpu::ray_marcher::RayMarcher gpu_marcher;
  for (int degree = 0; degree <= 3; ++degree)
    for (int p = 0; p < 3; ++p)
      agree(marcher, gpu_marcher, map_of(degree, profiles[p], p == 1), exact,
            fmt::format("exact, degree {}, profile {}", degree, p), degree == 0 ? 0.8 : 0.99);
  for (const bool beside : {false, true})
    agree(marcher, gpu_marcher, box_of(beside), exact, beside ? "exact, box beside Gaussians" : "exact, box");
}

}  // namespace series_test
