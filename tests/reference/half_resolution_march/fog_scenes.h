// Scenes with closed forms for the tests of the half-resolution march.
#pragma once
#include "reference/half_resolution_march/half_resolution_march.h"
#include "tests/pictures.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace airlight::half_resolution_march {

using test::Given;

// Every pixel a ray of its own, steps at their middles, no filter.
inline Given plain(int steps, Given more = {}) {
  more.insert({{"divide", "1"}, {"jitter", "none"}, {"steps", std::to_string(steps)}});
  return more;
}

inline scene::Film picture(const std::shared_ptr<const scene::Scene>& scene, const Given& given, int threads = 2) {
  return test::picture(HalfResolutionMarch(), scene, given, threads);
}

// Seen along -z by parallel rays: fog from z = 0 to z = -depth, of constant extinction, under a sun. With self_shadow = none the source is
// constant: airlight = albedo phase irradiance (1 - exp(-extinction depth)).
struct SlabOfFog {
  Rgb extinction{0.5, 1, 2};
  double depth = 2, albedo = 0.8, irradiance = 3;

  std::shared_ptr<scene::Scene> scene(int width = 8, int height = 6) const {
    auto scene = ray_marcher::make_scene(
        {ray_marcher::make_medium(scene::Homogeneous{1}, Box{Point3(-100, -100, -depth), Point3(100, 100, 0)},
                                  extinction, Rgb::Constant(albedo))},
        {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Constant(irradiance)}});
    scene->camera = scene::look_at(Point3(0, 0, 5), Point3::Zero(), Vec3::UnitY());
    scene->camera.kind = scene::Camera::Kind::orthographic;
    scene->camera.height = 2;
    scene->width = width;
    scene->height = height;
    finish(*scene);
    return scene;
  }
  Rgb transmittance(double length) const { return (-extinction * length).exp(); }
  Rgb airlight(double length) const {
    return albedo * irradiance / (4 * pi) * extinction.unaryExpr([&](double k) { return -std::expm1(-k * length); });
  }
};

}  // namespace airlight::half_resolution_march
