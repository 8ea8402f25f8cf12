// The scenes of the sweep, as files, with factors on what they hold.
#include <fmt/format.h>

#include <cmath>

#include "tests/stress/sweep.h"

namespace airlight::stress {
namespace {

// Factors on lengths, extinction per density, densities, light.
struct Factors {
  double length = 1, sigma_t = 1, density = 1, light = 1;
};

std::string number(double x) { return fmt::format("{:.17g}", x); }
std::string point(double x, double y, double z) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, z); }

std::string camera(double length, double z = 4) {
  return "camera = { position = " + point(0.1 * length, 0.3 * length, z * length) +
         ", look_at = [0, 0, 0] }\nfilm = { width = 3, height = 3 }\n";
}

std::string point_light(const Factors& f) {
  return "[[light]]\ntype = 'point'\nposition = " + point(1.5 * f.length, 2 * f.length, 0.5 * f.length) +
         "\nintensity = " + number(10 * f.light) + "\n";
}

std::string medium(const std::string& type, const Factors& f, const std::string& keys) {
  return "[[medium]]\ntype = '" + type + "'\nalbedo = 0.9\nsigma_t = " + number(f.sigma_t) + "\n" + keys + "\n";
}

std::string homogeneous(const Factors& f, double density, const std::string& region) {
  return medium("homogeneous", f, "density = " + number(density * f.density) + "\nregion = " + region);
}

std::string sphere_region(double radius) {
  return "{ type = 'sphere', center = [0, 0, 0], radius = " + number(radius) + " }";
}

// The box casts its shadow into the view, or, away from the light, out of it, for what knows no shadows in the air.
std::string surfaces(double l, bool shadow) {
  const double x = shadow ? 0 : -2.05, y = shadow ? 0 : -1, z = shadow ? 0 : -1.15;
  return "[[surface]]\ntype = 'box'\nlo = " + point((0.6 + x) * l, (0.8 + y) * l, (0.1 + z) * l) +
         "\nhi = " + point((0.9 + x) * l, (1.1 + y) * l, (0.4 + z) * l) +
         "\n[[surface]]\ntype = 'plane'\npoint = " + point(0, -1.5 * l, 0) + "\n";
}

std::string ball(const Factors& f) {
  return camera(f.length) + point_light(f) + homogeneous(f, 0.7, sphere_region(f.length)) + surfaces(f.length, true);
}

std::string fog(const Factors& f) {
  return camera(f.length) + point_light(f) + homogeneous(f, 0.1, "{ type = 'unbounded' }") + surfaces(f.length, false);
}

std::string blobs(const Factors& f) {
  const double l = f.length, d = f.density;
  return medium("gaussians", f,
                "gaussians = [{ center = [0, 0, 0], width = " + number(0.6 * l) + ", amplitude = " + number(0.8 * d) +
                    " }, { center = " + point(0.5 * l, 0.2 * l, -0.3 * l) + ", width = " + number(0.9 * l) +
                    ", amplitude = " + number(0.3 * d) + " }]");
}

std::string smoke(const Factors& f) { return camera(f.length) + point_light(f) + blobs(f); }

std::string sky(const Factors& f) {
  return camera(f.length) + "[[light]]\ntype = 'environment'\nradiance = " + number(f.light) + "\n" + blobs(f);
}

std::string harmonics(const Factors& f) {
  const std::string zero = "[0, 0, 0]", one = point(f.light, f.light, f.light),
                    tilt = point(0.3 * f.light, 0.3 * f.light, 0.3 * f.light);
  return camera(f.length) + "[[light]]\ntype = 'environment'\nsh = [" + one + ", " + tilt + ", " + zero + ", " + tilt +
         "]\n" + blobs(f);
}

const std::string sun = "[[light]]\ntype = 'directional'\nto_light = [0.6, 0.64, 0.48]\n";

std::string grid(const Factors& f) {
  std::string values;
  for (int i = 0; i < 27; ++i) values += number((5 * i % 7 + 1) / 7.0 * f.density) + ", ";
  return camera(f.length) + sun + "irradiance = " + number(3 * f.light) + "\n" +
         medium("grid", f,
                "size = [3, 3, 3]\nvoxel_size = " + number(0.6 * f.length) + "\norigin = " +
                    point(-0.6 * f.length, -0.6 * f.length, -0.6 * f.length) + "\nvalues = [" + values + "]");
}

std::string sunny(const Factors& f) { return camera(f.length) + sun + "irradiance = " + number(3 * f.light) + "\n"; }

// Fog over the ground, thinner with the height.
std::string fogmap(const Factors& f) {
  std::string values;
  for (int i = 0; i < 16; ++i) values += number((5 * i % 7 + 1) / 7.0 * f.density) + ", ";
  const double l = f.length;
  return sunny(f) + medium("fogmap", f,
                           "degree = 1\ncell = " + number(0.5 * l) + "\ncorner = [" + number(-l) + ", " + number(-l) +
                               "]\nsize = [4, 4]\nvalues = [" + values +
                               "]\nprofile = { type = 'layers', heights = " + point(-l, 0.2 * l, l) +
                               ", factors = [1, 0.6, 0] }\nregion = { type = 'slab', normal = [0, 1, 0], lo = " +
                               number(-l) + ", hi = " + number(l) + " }");
}

// A polynomial of degree 2, 1, 1, above 0 in its box.
std::string polynomial(const Factors& f) {
  const double l = f.length, d = f.density;
  std::string values;
  for (const double c : {2.0, 0.3, 0.2, 0.1, -0.4, 0.1, 0.05, 0.0, -0.3, 0.05, 0.0, 0.1})
    values += number(c * d) + ", ";
  return sunny(f) + medium("legendre", f,
                           "lo = " + point(-l, -0.8 * l, -l) + "\nhi = " + point(l, 0.8 * l, l) +
                               "\nsize = [3, 2, 2]\ncoefficients = [" + values + "]");
}

// One pixel, whose ray passes through the origin along -z.
const std::string pinhole =
    "camera = { position = [0, 0, 4], look_at = [0, 0, 0] }\nfilm = { width = 1, height = 1 }\n";

std::string one_gaussian(double width, double amplitude = 0.1) {
  return pinhole + point_light({}) +
         medium("gaussians", {},
                "gaussians = [{ center = [0, 0, 0], width = " + number(width) + ", amplitude = " + number(amplitude) +
                    " }]");
}

// The lamp is 4.3 m from the camera.
std::string deep_lamp(double depth) {
  return camera(1) + point_light({}) + homogeneous({}, depth / 4.3, "{ type = 'unbounded' }");
}

std::string one_voxel(double size) {
  return pinhole + point_light({}) +
         medium("grid", {}, "size = [1, 1, 1]\norigin = [0, 0, 0]\nvalues = [0.1]\nvoxel_size = " + number(size));
}

std::string slab(double thickness) {
  return pinhole + point_light({}) +
         homogeneous({}, 1, "{ type = 'slab', normal = [0, 0, 1], lo = 0, hi = " + number(thickness) + " }");
}

std::string box(double thickness) {
  return pinhole + point_light({}) +
         homogeneous({}, 1, "{ type = 'box', lo = [-1, -1, 0], hi = [1, 1, " + number(thickness) + "] }");
}

std::string sphere(double radius) { return pinhole + point_light({}) + homogeneous({}, 1, sphere_region(radius)); }

std::string far_light(double distance) {
  return camera(1) +
         "[[light]]\ntype = 'point'\nposition = " + point(0.6 * distance, 0.64 * distance, 0.48 * distance) +
         "\nintensity = " + number(distance < 1e150 ? 3 * distance * distance : 3) + "\n" +
         homogeneous({}, 0.7, sphere_region(1));
}

std::string far_camera(double distance) {
  return "camera = { type = 'orthographic', height = 2, position = " + point(0, 0, distance) +
         ", look_at = [0, 0, 0] }\nfilm = { width = 3, height = 3 }\n" + point_light({}) +
         homogeneous({}, 0.7, sphere_region(1));
}

std::string beside_in_ball(double distance) {
  return pinhole + "[[light]]\ntype = 'point'\nintensity = 1\nposition = " + point(distance, 0, 0) + "\n" +
         homogeneous({}, 0.1, sphere_region(1));
}

std::string beside(double distance) {
  return pinhole + "[[light]]\ntype = 'point'\nintensity = 1\nposition = " + point(distance, 0, 0) + "\n" +
         homogeneous({}, 0.1, "{ type = 'unbounded' }");
}

// Below a lamp: its top lies at y = -1.
std::string large_sphere(double radius) {
  return "camera = { position = [0, 3, 2], look_at = [0, -1, 0], vertical_fov = 0.4 }\nfilm = { width = 3, height = 3 "
         "}\n" +
         point_light({}) + homogeneous({}, 0.05, sphere_region(3)) +
         "[[surface]]\ntype = 'sphere'\ncenter = " + point(0, -1 - radius, 0) + "\nradius = " + number(radius) + "\n";
}

double one(double) { return 1; }
double same(double s) { return s; }

using Make = std::string (*)(const Factors&);

// The laws that hold for every scene.
void add_laws(std::vector<SweepCase>& cases, const std::string& name, Make make, bool point_lit) {
  const auto squared = [](double s) { return s > 1e150 ? 1e300 : s * s; };
  cases.push_back({"intensity", name, [=](double s) { return make({1, 1, 1, s}); }, same, 1});
  cases.push_back({"extinction times density", name, [=](double s) { return make({1, s, 1 / s, 1}); }, one, 1});
  cases.push_back({"all lengths", name,
                   [=](double s) {
                     return make({s, 1 / s, 1, point_lit ? squared(s) : 1});
                   },
                   one, 1});
  // Linear to the optical depth.
  cases.push_back({"extinction, thin", name,
                   [=](double s) {
                     return make({1, s, 1, 1});
                   },
                   same, 1e-6, 0, 1e-6, "airlight", 1e-5});
  cases.push_back({"density, thin", name,
                   [=](double s) {
                     return make({1, 1, s, 1});
                   },
                   same, 1e-6, 0, 1e-6, "airlight", 1e-5});
}

}  // namespace

std::vector<SweepCase> sweep_cases() {
  std::vector<SweepCase> cases;
  add_laws(cases, "ball", ball, true);
  add_laws(cases, "fog", fog, true);
  add_laws(cases, "smoke", smoke, true);
  add_laws(cases, "grid", grid, false);
  add_laws(cases, "sky", sky, false);
  add_laws(cases, "harmonics", harmonics, false);
  add_laws(cases, "fogmap", fogmap, false);
  add_laws(cases, "polynomial", polynomial, false);
  // A half space: nothing but the angles matters, to 1/(extinction * radius).
  const auto thick = [](double s) { return ball({1, s, 1, 1}); };
  cases.push_back({"extinction, thick", "ball", thick, one, 1e5, 1e5, 1e301, "airlight", 1e-4});
  // Nothing comes through; beside the picture at 1.
  const auto dark = [](double s) { return fog({1, s, 1, 1}); };
  cases.push_back({"extinction, thick", "fog", dark, one, 1, 1e3, 1e301, "mean", 1e-5, true});
  cases.push_back({"amplitude, thick", "smoke",
                   [](double s) {
                     return smoke({1, 1, s, 1});
                   },
                   one, 1, 1e12, 1e301, "mean", 1e-3, true});
  // Between those ends nothing holds but the truth: one density, and one optical depth, thin and thick.
  std::vector<double> widths;
  for (int e = -8; e <= 8; ++e) widths.push_back(std::pow(10, 0.5 * e));
  const auto add_widths = [&](const std::string& quantity, std::function<std::string(double)> text) {
    cases.push_back({quantity, "gaussian", std::move(text), one, 1, 0, 1e301, "airlight", 0, false, widths});
  };
  add_widths("width, one density", [](double s) { return one_gaussian(s); });
  add_widths("width, depth 0.02", [](double s) { return one_gaussian(s, 0.01 / s); });
  add_widths("width, depth 1.8", [](double s) { return one_gaussian(s, 1 / s); });
  add_widths("width, depth 18", [](double s) { return one_gaussian(s, 10 / s); });
  // A lamp at the depth s of endless fog.
  cases.push_back({"depth of the lamp",
                   "fog",
                   deep_lamp,
                   one,
                   1,
                   0,
                   1e301,
                   "airlight",
                   0,
                   false,
                   {0.01, 0.1, 1, 3, 6, 10, 15, 20, 30, 40, 50, 60, 70, 80}});
  // Optical depth in proportion to the size; then a constant density.
  cases.push_back(
      {"width, narrow", "gaussian", [](double s) { return one_gaussian(s); }, same, 1e-4, 0, 1e-4, "airlight", 1e-4});
  cases.push_back(
      {"width, wide", "gaussian", [](double s) { return one_gaussian(s); }, one, 1e5, 1e5, 1e301, "airlight", 1e-4});
  cases.push_back({"voxel, small", "voxel", one_voxel, same, 1e-4, 0, 1e-4, "airlight", 1e-4});
  cases.push_back({"voxel, large", "voxel", one_voxel, one, 1e6, 1e6, 1e301, "airlight", 1e-4});
  cases.push_back({"region, thin", "slab", slab, same, 1e-4, 0, 1e-4, "airlight", 1e-3});
  cases.push_back({"region, thin", "box", box, same, 1e-4, 0, 1e-4, "airlight", 1e-3});
  cases.push_back({"region, thin", "sphere", sphere, same, 1e-4, 0, 1e-4, "airlight", 1e-3});
  cases.push_back({"region, large", "sphere", sphere, one, 1e6, 1e6, 1e301, "airlight", 1e-4});
  cases.push_back({"distance of the light", "ball", far_light, one, 1e6, 1e6, 1e301, "mean", 1e-5});
  cases.push_back({"distance of the camera", "ball", far_camera, one, 10, 10, 1e301, "mean", 1e-6});
  cases.push_back(
      {"light beside a ray", "fog", beside, [](double s) { return 1 / s; }, 1e-5, 0, 1e-5, "airlight", 1e-4});
  cases.push_back(
      {"light beside a ray", "ball", beside_in_ball, [](double s) { return 1 / s; }, 1e-5, 0, 1e-5, "airlight", 1e-4});
  cases.push_back({"radius, large", "surface", large_sphere, one, 1e5, 1e5, 1e301, "surface", 1e-4});
  return cases;
}

std::vector<double> sweep_values(int step) {
  std::vector<double> values;
  for (const int e : {-300, -200, -150, -100, -60, -45, -38}) values.push_back(std::pow(10, e));
  for (int e = -33; e <= 33; e += step) values.push_back(std::pow(10.0, e));
  for (const int e : {38, 45, 60, 100, 150, 200, 300}) values.push_back(std::pow(10, e));
  return values;
}

}  // namespace airlight::stress
