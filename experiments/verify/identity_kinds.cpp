// Conservation laws: furnace, collision counts, reciprocity, limits.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "experiments/verify/monte_carlo.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "reference/deterministic/airlight.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments::verification {
namespace {

struct Fog {
  std::string name;
  scene::Medium medium;
};

std::shared_ptr<const scene::VoxelGrid> lumpy_grid() {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = Eigen::Vector3i::Constant(6);
  grid->voxel_size = 0.25;
  grid->translation = Vec3::Constant(-0.625);
  for (int i = 0; i < 216; ++i) grid->values.push_back(float((7 * i + 3 * (i / 6) + i / 36) % 11));
  return grid;
}

// Every field that exists, every phase function, albedo 1; all within two metres of the origin.
std::vector<Fog> furnace_media() {
  const scene::Region ball = scene::Sphere{Point3::Zero(), 1};
  scene::Medium gaussians = fog(Box{Point3::Constant(-1), Point3::Constant(1)}, 1, 1, scene::HenyeyGreenstein{0.5});
  gaussians.field =
      scene::GaussianSum{{{Point3(0.2, 0, 0.3), 0.4, 6}, {Point3(-0.4, 0.3, -0.2), 0.3, 9}}, 0.1, infinity};
  scene::Medium grid = fog(scene::Unbounded{}, 0.5, 1, scene::Hazy{});
  grid.field = lumpy_grid();
  return {{"isotropic ball", fog(ball, 3, 1, scene::Isotropic{})},
          {"Rayleigh ball", fog(ball, 3, 1, scene::Rayleigh{})},
          {"HG 0.9 ball", fog(ball, 8, 1, scene::HenyeyGreenstein{0.9})},
          {"HG -0.7 ball", fog(ball, 3, 1, scene::HenyeyGreenstein{-0.7})},
          {"hazy box", fog(Box{Point3::Constant(-0.8), Point3::Constant(0.8)}, 3, 1, scene::Hazy{})},
          {"murky slab", fog(scene::Slab{Vec3::UnitY(), -0.5, 0.5}, 3, 1, scene::Murky{})},
          {"Gaussians", gaussians},
          {"grid", grid}};
}

scene::Scene furnace(const std::vector<scene::Medium>& media, bool white_ball) {
  scene::Scene scene;
  scene.media = media;
  scene.lights = {scene::make_constant_environment(Rgb::Ones())};
  if (white_ball) scene.surfaces = {{"white", scene::Sphere{Point3(0.1, 0.2, 0), 0.3}, scene::Lambert{Rgb::Ones()}}};
  scene::finish(scene);
  return scene;
}

Comparison mean_one(const std::string& name, double expected, const scene::Scene& scene, const Ray& ray,
                    const Effort& effort) {
  const auto got = Measurement(scene, ray, 1, "furnace " + name).run(effort);
  // A walk without next-event estimation would have no variance at all: rounding is allowed for.
  return statistical(name, expected, 0, got.total.mean[0], got.total.error[0], accept_se, 1e-9);
}

Check read_furnace(const Value& v) {
  const double expected = v["expected"]["L"].number();
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            const Effort effort = fixed(profile == VerifyProfile::quick ? 1 << 15 : 1 << 20, profile);
            const Ray ray{Point3(0.1, -0.2, -3), Vec3(0.05, 0.08, 1).normalized()};
            std::vector<scene::Medium> all;
            for (const Fog& f : furnace_media()) {
              out.add(mean_one(f.name, expected, furnace({f.medium}, false), ray, effort));
              if (!std::holds_alternative<scene::Slab>(f.medium.region)) all.push_back(f.medium);
            }
            out.add(mean_one("all at once", expected, furnace(all, false), ray, effort));
            out.add(mean_one("all, white ball", expected, furnace(all, true), ray, effort));
            if (profile == VerifyProfile::paper) {
              scene::Medium thick = fog(scene::Sphere{Point3::Zero(), 1}, 500, 1, scene::Isotropic{});
              out.add(mean_one("optical depth 1000", expected, furnace({thick}, false), ray, fixed(1 << 14, profile)));
            } else {
              out.left_out = 1;
              out.left_out_because = "optical depth 1000 is for the paper profile";
            }
            return out;
          }};
}

// Paths that enter a convex region evenly over its boundary, cosine-weighted, albedo 1: mean collisions. Student's t
// with 15 degrees of freedom: 6.6 standard errors are as rare as 4.5 of a known one.
Comparison collisions(const std::string& name, double expected, const scene::Medium& medium, const Detector& entry,
                      const Effort& effort) {
  const auto got = Measurement(furnace({medium}, false), entry, 1, "collisions " + name).collisions(effort);
  return statistical(name, expected, 0, got.mean[0], got.error[0], 6.6);
}

// Points on the unit sphere or on the faces of the unit cube [0, 1]^3, pushed out a little, with a cosine-weighted
// direction inwards. The detector gets two uniforms: the upper and lower halves of their digits serve twice.
std::array<double, 4> four(const RandomBlock& random) {
  std::array<double, 4> u;
  for (int i = 0; i < 2; ++i) {
    const double scaled = random.fine(i) * 67108864.0;  // 2^26
    const double high = std::floor(scaled);
    u[2 * i] = (high + 0.5) / 67108864.0;
    u[2 * i + 1] = scaled - high;
  }
  return u;
}

Ray inwards(const Point3& x, const Vec3& normal, double u1, double u2) {
  const Vec3 axis = -normal, a = axis.unitOrthogonal(), b = axis.cross(a);
  const double cosine = std::sqrt(u1), sine = std::sqrt(1 - u1), angle = 2 * pi * u2;
  const Vec3 d = (cosine * axis + sine * (std::cos(angle) * a + std::sin(angle) * b)).normalized();
  return {x - 1e-3 * d, d};
}

Detector sphere_entry() {
  return [](const RandomBlock& random) {
    const auto u = four(random);
    const double z = 2 * u[0] - 1, r = std::sqrt(1 - z * z), angle = 2 * pi * u[2];
    const Vec3 n(r * std::cos(angle), r * std::sin(angle), z);
    return inwards(n, n, u[1], u[3]);
  };
}

Detector cube_entry() {
  return [](const RandomBlock& random) {
    const auto u = four(random);
    const double six = 6 * u[0];
    const int face = std::min(5, int(six)), axis = face / 2;
    Point3 x;
    x[axis] = face % 2;
    x[(axis + 1) % 3] = six - face;
    x[(axis + 2) % 3] = u[2];
    Vec3 n = Vec3::Zero();
    n[axis] = face % 2 ? 1 : -1;
    return inwards(x, n, u[1], u[3]);
  };
}

Check read_collisions(const Value& v) {
  const Value e = v["expected"];
  const double radius = v["input"]["sphere_optical_radius"].number_in(0, 1e4);
  const double sphere = e["mean_collisions"].number(), per_tau = e["slab_per_unit_tau"].number();
  const double per_edge = e["cube_per_unit_optical_edge"].number();
  return {"", [=](VerifyProfile profile) {
            const Effort effort = fixed(profile == VerifyProfile::quick ? 1 << 18 : 1 << 23, profile);
            const Detector slab = cosine_detector(Point3(0, 0, -1), Vec3::UnitZ());
            const Box cube{Point3::Zero(), Point3::Ones()};
            Outcome out;
            const auto ball = [&](const scene::PhaseFunction& p) {
              return fog(scene::Sphere{Point3::Zero(), 1}, radius, 1, p);
            };
            out.add(collisions("sphere isotropic", sphere, ball(scene::Isotropic{}), sphere_entry(), effort));
            out.add(collisions("sphere HG 0.8", sphere, ball(scene::HenyeyGreenstein{0.8}), sphere_entry(), effort));
            const scene::Region layer = scene::Slab{Vec3::UnitZ(), 0, 1};
            out.add(collisions("slab tau 3", 3 * per_tau, fog(layer, 3, 1, scene::Murky{}), slab, effort));
            out.add(collisions("cube edge 4", 4 * per_edge, fog(cube, 4, 1, scene::Rayleigh{}), cube_entry(), effort));
            // The law 4 int sigma dV / S for a field that varies: the grid's tent functions have the volume h^3 each.
            scene::Medium grid = fog(scene::Unbounded{}, 0.5, 1, scene::Hazy{});
            auto field = std::make_shared<scene::VoxelGrid>(*lumpy_grid());
            // 6 samples a side, support 7 voxels of 1/7: exactly the unit cube.
            field->voxel_size = 1.0 / 7;
            field->translation = Vec3::Constant(1.0 / 7);
            double integral = 0;
            for (const float value : field->values) integral += value * std::pow(field->voxel_size, 3);
            grid.field = std::shared_ptr<const scene::VoxelGrid>(field);
            out.add(collisions("cube grid", 4 * 0.5 * integral / 6, grid, cube_entry(), effort));
            return out;
          }};
}

// The bidirectional kernel of a slab: radiance at (mu, phi) under a beam at mu0, over mu0, is the same with both
// swapped.
Check read_reciprocity(const Value& v) {
  const double expected = v["expected"]["difference"].number();
  return {"", [=](VerifyProfile profile) {
            const Effort effort = fixed(profile == VerifyProfile::quick ? 1 << 19 : 1 << 23, profile);
            Outcome out;
            for (const auto& [name, phase] :
                 {std::pair<const char*, scene::PhaseFunction>{"HG 0.6", scene::HenyeyGreenstein{0.6}},
                  {"Rayleigh", scene::Rayleigh{}}}) {
              const auto kernel = [&, n = name, p = phase](const Vec3& to_light, const Vec3& to_eye) {
                scene::Scene scene;
                scene.media = {fog(scene::Slab{Vec3::UnitZ(), -2, 0}, 1, 0.95, p)};
                scene.lights = {scene::DirectionalLight{to_light, Rgb::Ones()}};
                scene::finish(scene);
                const std::string run = std::string("reciprocity ") + n + std::to_string(to_light[2]);
                const auto got = Measurement(scene, Ray{to_eye, -to_eye}, 1, run).run(effort);
                return std::pair{got.total.mean[0] / to_light[2], got.total.error[0] / to_light[2]};
              };
              const Vec3 a = Vec3(0.3, 0.1, 0.9).normalized(), b = Vec3(-0.6, 0.7, 0.4).normalized();
              const auto [one, one_se] = kernel(a, b);
              const auto [two, two_se] = kernel(b, a);
              out.add(statistical(std::string("slab kernel ") + name, expected, one_se, one - two, two_se, accept_se));
            }
            return out;
          }};
}

Check read_limits(const Value& v) {
  const Value e = v["expected"];
  const double thin = e["sphere_thin_L1_over_chord_tau"].number(), accuracy = v["accuracy"]["abs"].number();
  const double r20 = e["R_mu1_iso_0.9_tau20"].number(), infinite = e["R_mu1_iso_0.9_inf"].number();
  return {
      "", [=](VerifyProfile profile) {
        // The thin ball of the single-scattering vectors, per optical depth of its chord of 2 sqrt(1 - 0.5^2).
        scene::Scene scene;
        scene.media = {fog(scene::Sphere{Point3::Zero(), 1}, 1e-4, 1, scene::Isotropic{})};
        scene.lights = {scene::PointLight{Point3(2, 0, 0), Rgb::Ones(), 0}};
        const double order_one =
            deterministic::airlight(scene, {Point3(0.5, 0, -3), Vec3::UnitZ()}, infinity).radiance[0];
        Outcome out{{absolute("thin L1 / tau", thin, order_one / (1e-4 * std::sqrt(3.0)), accuracy)}};
        for (const auto& [tau, expected] : {std::pair{20.0, r20}, std::pair{1e6, infinite}}) {
          scene::Scene slab;
          slab.media = {fog(scene::Slab{Vec3::UnitZ(), 0, tau}, 1, 0.9, scene::Isotropic{})};
          slab.lights = {scene::make_constant_environment(Rgb::Ones())};
          slab.surfaces = {{"black", scene::Plane{Point3(0, 0, tau + 1), Vec3::UnitZ()}, scene::Lambert{Rgb::Zero()}}};
          scene::finish(slab);
          const std::string name = "R tau " + std::to_string(int(tau));
          const auto got = Measurement(slab, Ray{Point3(0, 0, -1), Vec3::UnitZ()}, 1, name).run(aim(2.7e-4, profile));
          out.add(statistical(name, expected, 0, got.total.mean[0], got.total.error[0], accept_se, accuracy));
        }
        return out;
      }};
}

}  // namespace

Check read_identity(const Value& v) {
  const Value expected = v["expected"];
  if (expected.has("L")) return read_furnace(v);
  if (expected.has("mean_collisions")) return read_collisions(v);
  if (expected.has("sphere_thin_L1_over_chord_tau")) return read_limits(v);
  if (expected.has("difference")) return read_reciprocity(v);
  expected.complain("L, mean_collisions, sphere_thin_L1_over_chord_tau or difference");
}

}  // namespace airlight::experiments::verification
