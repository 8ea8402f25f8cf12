// The stress list of compensated ray marching (section 10 of its specification), as far as pictures show it: scenes that both backends draw,
// and what each picture must be. tests/stress/README.md lists the rest of the rows.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/convert/gaussian_fit.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/convert/residual.h"
#include "scene/math/spherical_harmonics.h"
#include "scene/media/fitted.h"
#include "tests/methods/compensated_ray_marching/puffs.h"

namespace airlight::test {

struct StressScene {
  int row;
  std::string what;
  std::shared_ptr<scene::Scene> scene;
  double sigma;      // sigma_t * greatest density * longest side
  double brightest;  // greatest radiance that comes in
  Given given = {};  // settings besides the variant
  bool for_paper = true, for_grid = true;
  bool for_device = true;  // false: single precision refuses it by name
};

// The settings of a stress scene for one of the variants. Settings that only the other variant reads are left out.
inline Given given_of(const StressScene& s, bool paper) {
  Given given = s.given;
  given["variant"] = paper ? "paper" : "grid";
  return scene::without_unread(compensated_ray_marching::CompensatedRayMarching().settings(), given);
}

class StressScenes {
 public:
  static const std::vector<StressScene>& all() {
    static const std::vector<StressScene> made = [] {
      StressScenes s;
      s.gaussians();
      s.depths();
      s.voxels();
      s.lights_and_cameras();
      return std::move(s.scenes_);
    }();
    return made;
  }

  static scene::EnvironmentLight white() { return scene::make_constant_environment(Rgb::Ones()); }
  // Radiance 0.2 to 1.8 in the red, 0.5 to 1.5 in the green, less in the blue.
  static scene::EnvironmentLight uneven() {
    const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    return scene::make_sh_environment(
        {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5 * slope, 0), Rgb(0, 0, 0.4)}, turn, Rgb::Ones());
  }

 private:
  std::vector<StressScene> scenes_;

  static scene::GaussianSum sum_of(std::vector<scene::Gaussian> gaussians) {
    scene::GaussianSum sum;
    sum.cutoff = 3;
    sum.gaussians = std::move(gaussians);
    return sum;
  }
  static double density_times_side(const scene::Medium& smoke) {
    const Box box = bounding_box(smoke);
    double most = 0;
    for (int i = 0; !box.empty() && i < 21 * 21 * 21; ++i)
      most = std::max(most, density(smoke, box.lo + box.size().cwiseProduct(Vec3(i % 21, i / 21 % 21, i / 441) / 20)));
    return box.empty() ? 0 : most * box.size().maxCoeff();
  }
  StressScene& add(int row, const std::string& what, scene::DensityField field, double sigma_t, double albedo,
                   scene::EnvironmentLight light = uneven(), double brightest = 1.8) {
    const auto s = scene_of(std::move(field), sigma_t, albedo, std::move(light));
    scenes_.push_back({row, what, s, sigma_t * density_times_side(s->media[0]), brightest});
    return scenes_.back();
  }

  void gaussians() {
    add(1, "no Gaussian", sum_of({}), 2, 0.8);
    add(1, "a Gaussian of density 0", sum_of({{{0, 0, 0}, 0.5, 0}}), 2, 0.8);
    add(2, "one Gaussian", sum_of({{{0, 0, 0}, 0.5, 1}}), 4, 0.8);
    add(3, "two at one place", sum_of({{{0, 0, 0}, 0.5, 0.5}, {{0, 0, 0}, 0.5, 0.5}}), 4, 0.8);
    // An odd number of nodes has one at the centre, and so has the eye.
    StressScene& centre = add(14, "the eye and a node at a centre", sum_of({{{0, 0, 0}, 0.5, 1}}), 4, 0.8);
    centre.given = {{"cells", "13"}};
    centre.scene->camera = scene::look_at({0, 0, 0}, {1, 0, 0}, Vec3::UnitY());
    for (const double widths : {1.0, 3.0})
      for (const double place : {std::nextafter(widths, 0.0), widths, std::nextafter(widths, 4.0)}) {
        StressScene& at = add(15, "the eye as many widths away", sum_of({{{0, 0, 0}, 1, 1}}), 2, 0.8);
        at.scene->camera = scene::look_at({place, 0, 0}, {0, 0, 0}, Vec3::UnitY());
      }
    std::vector<scene::Gaussian> many(600, {{0.1, 0.2, 0}, 0.4, 1.0 / 600});
    for (const char* transmittance : {"ol", "hyb", "series", "directional"}) {
      StressScene& deep = add(22, "600 at one place, 1000 deep", sum_of(many), 1000 / (0.4 * std::sqrt(pi)), 0.8);
      deep.given = {{"deepest_cell", "1e9"}, {"slices", "64"}, {"transmittance", transmittance}};
      deep.for_grid = transmittance == std::string("ol");
    }
    scene::GaussianSum idle = puffs(), tiny = puffs();
    idle.gaussians.push_back({{0, 0, 0.1}, 0.5, 0});
    tiny.gaussians.push_back({{0.9, 0.9, 0.9}, 0.5, 1e-39});
    add(27, "one without weight", idle, 4, 0.8);
    add(28, "one whose density is a denormal number", tiny, 4, 0.8);
    StressScene& nothing = add(28, "nothing but that", sum_of({{{0, 0, 0}, 0.5, 1e-39}}), 4, 0.8);
    nothing.for_device = false;
  }

  void depths() {
    add(4, "albedo 0", puffs(), 4, 0);
    for (const double sigma_t : {0.5, 4.0, 12.0}) {
      add(5, "albedo 1", puffs(), sigma_t, 1, white(), 1).for_paper = false;
      add(5, "albedo 1 in uneven light", puffs(), sigma_t, 1).for_paper = false;
    }
    add(6, "sigma_t 1e-6", puffs(), 1e-6, 0.9, white(), 1);
    // With densities up to 1.5 and 2.7 m across: 1e4 and 2e4 of sigma.
    for (const double sigma_t : {2.5e3, 5e3}) {
      add(7, "black smoke", puffs(), sigma_t, 0.8, white(), 1).given = {{"deepest_cell", "1e9"}};
      add(7, "white smoke", puffs(), sigma_t, 1, white(), 1).given = {{"deepest_cell", "1e9"}};
      scenes_.back().for_paper = false;
    }
    for (const double g : {-0.99, 0.99})
      add(8, "|g| = 0.99", puffs(), 3, 0.9).scene->media[0].phase = scene::HenyeyGreenstein{g};
  }

  static scene::VoxelGrid grid_of(const Eigen::Vector3i& size, bool clamped) {
    scene::VoxelGrid grid;
    grid.size = size;
    grid.voxel_size = 1.2 / size.maxCoeff();
    grid.translation = -0.5 * grid.voxel_size * (size.cast<double>() - Vec3::Ones());
    grid.clamp_border = clamped;
    for (int i = 0; i < size.prod(); ++i) grid.values.push_back(0.5F + 0.4F * float(i * 7 % 5) / 4);
    return grid;
  }
  // Seen from aside, so that thin ones are seen too.
  StressScene& add_aside(int row, const std::string& what, scene::DensityField field) {
    StressScene& s = add(row, what, std::move(field), 4, 0.8);
    s.scene->camera = scene::look_at({2.2, 1.5, 2.6}, {0, 0, 0}, Vec3::UnitY());
    s.scene->camera.vertical_fov = 0.5;
    return s;
  }
  // The grid, and its fit with the residual, which is what variant = paper knows.
  void add_both(int row, const std::string& what, const scene::VoxelGrid& grid, int gaussians) {
    add_aside(row, what, std::make_shared<const scene::VoxelGrid>(grid)).for_paper = false;
    scene::FitOptions options;
    options.gaussians = gaussians;
    auto fitted = std::make_shared<scene::Fitted>();
    fitted->gaussians = scene::fit_gaussians(grid, options).sum;
    fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, fitted->gaussians, {0, {}}));
    fitted->grid = scene::decoded(fitted->gaussians, *fitted->residual);
    add_aside(row, what + ", fitted", scene::FittedPointer(fitted));
    add_aside(row, what + ", its Gaussians alone", scene::FittedPointer(fitted)).given = {{"residual", "false"}};
  }
  void voxels() {
    scene::VoxelGrid zero = grid_of({4, 4, 4}, false);
    std::fill(zero.values.begin(), zero.values.end(), 0.0F);
    add(1, "voxels of density 0", std::make_shared<const scene::VoxelGrid>(zero), 2, 0.8).for_paper = false;
    add_both(12, "1 x 1 x 1, clamped", grid_of({1, 1, 1}, true), 1);
    add_both(12, "1 x 1 x 1", grid_of({1, 1, 1}, false), 1);
    add_both(13, "2 x 3 x 5", grid_of({2, 3, 5}, false), 4);
    add_both(13, "1 x 9 x 9", grid_of({1, 9, 9}, true), 6);
    add_both(13, "9 x 1 x 1", grid_of({9, 1, 1}, false), 3);
    scene::VoxelGrid one = grid_of({9, 9, 9}, false), full = one;
    std::fill(one.values.begin(), one.values.end(), 0.0F);
    one.values[4 + 9 * (4 + 9 * 4)] = 3;
    add_both(17, "all density in one voxel", one, 4);
    full.clamp_border = true;
    std::fill(full.values.begin(), full.values.end(), 1.0F);
    add_both(18, "one density everywhere", full, 20);
    // A centre outside of the box, and one on its face: the residual takes back what lies within.
    auto outside = std::make_shared<scene::Fitted>();
    outside->gaussians = sum_of({{{0.8, 0, 0}, 0.3, 0.7}, {{0.6, 0.3, 0}, 0.2, 0.5}, {{0, 0, 0}, 0.2, 0.4}});
    const scene::VoxelGrid some = grid_of({8, 8, 8}, false);
    outside->residual = std::make_shared<const scene::Residual>(scene::residual_of(some, outside->gaussians, {0, {}}));
    outside->grid = scene::decoded(outside->gaussians, *outside->residual);
    add_aside(16, "centres outside the box", scene::FittedPointer(outside));
  }

  void lights_and_cameras() {
    // A sun towards (1, 2, 2) in four bands: below 0 over much of the sphere.
    const double power = 3;
    std::vector<Rgb> sun;
    double brightest = 0;
    for (const double y : scene::evaluate_sh(4, Vec3(1, 2, 2).normalized())) {
      sun.push_back(Rgb::Constant(power * y));
      brightest += power * y * y;
    }
    add(23, "a sun in four bands", puffs(), 4, 0.9, scene::make_sh_environment(sun, Mat3::Identity(), Rgb::Ones()),
        brightest);
    // Scattered forwards, in four bands, there is less than nothing to be seen with it in the back.
    StressScene& back = add(23, "a sun in four bands, in the back", puffs(), 0.5, 0.1,
                            scene::make_sh_environment(sun, Mat3::Identity(), Rgb::Ones()), brightest);
    back.given = {{"multiple", "none"}};
    back.scene->media[0].phase = scene::HenyeyGreenstein{0.6};
    back.scene->camera = scene::look_at({1.3, 2.7, 2.7}, {0, 0.1, 0}, Vec3::UnitY());
    add(24, "no light", puffs(), 4, 0.9, scene::make_constant_environment(Rgb::Zero()), 0);
    StressScene& inside = add(26, "the eye within, rays nearly along the slices", puffs(), 4, 0.9);
    inside.scene->camera = scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY());
    inside.scene->camera.vertical_fov = 3.13;
    for (StressScene& s : scenes_) finish(*s.scene);
  }
};

// Checks the rules for every picture of the list, and the rules of its row; for the variant grid unless `paper`.
inline void check_stress(const StressScene& s, const scene::Film& film, bool paper) {
  const std::vector<float>&mean = film.layer("mean"), &airlight = film.layer("airlight"),
        &surface = film.layer("surface"), &left = film.layer("transmittance");
  double most = 0;
  for (const auto& [name, values] : film.layers)
    for (const float v : values) REQUIRE(std::isfinite(v));
  for (std::size_t i = 0; i < mean.size(); ++i) {
    REQUIRE(airlight[i] >= 0);
    REQUIRE((left[i] >= 0 && left[i] <= 1));
    most = std::max(most, double(airlight[i]));
  }
  // Without bands that are missing, a source is a mean of the light: cells' means alone make it more (see the tests of albedo 1).
  if (!paper && s.row != 8 && s.row != 7 && s.row != 22) CHECK(most <= 1.02 * s.brightest);
  if (s.row == 1 || s.what == "nothing but that")  // the background exactly, but for light as small as that density
    for (std::size_t i = 0; i < mean.size(); ++i)
      REQUIRE((mean[i] == surface[i] && left[i] == 1 && airlight[i] <= (s.row == 1 ? 0 : 1e-37)));
  if (s.row == 4 || s.row == 24)
    for (const float v : airlight) REQUIRE(v == 0);
  if (s.row == 24)
    for (const float v : mean) REQUIRE(v == 0);
  if (s.row == 5) {  // no more than comes in; nothing is seen of what scatters everything in white light
    CHECK(*std::max_element(mean.begin(), mean.end()) <= 1.02 * s.brightest);
    if (s.brightest == 1)
      for (const float v : mean) CHECK(v >= 0.95);
  }
  if (s.row == 6)
    for (const float v : mean) REQUIRE(std::abs(v - 1) <= 1e-5);
  if (s.row == 7) {  // opaque in the middle, whose light is that of the surface
    // In cells a thousand deep, which must be asked for, light leaks: 1.8 of what comes in where all of it is scattered.
    const double bound = paper ? 1e3 : s.what == "white smoke" ? 2.5 : 1.5;
    CHECK(left[3 * (4 * s.scene->width + 6)] == 0);
    CHECK(most < bound);
  }
  if (s.row == 8)
    CHECK_THAT(film.metadata.at("warning"), Catch::Contains("order = 4"));
  else
    CHECK(film.metadata.count("warning") == 0);
}

}  // namespace airlight::test
