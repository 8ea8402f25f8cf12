#include "scene/single_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {
namespace {

constexpr double least_size = 1e-4, greatest_place = 1e6;             // [m]
constexpr double least_extinction = 1e-9, greatest_extinction = 1e9;  // [1/m]
constexpr double least_light = 1e-9, greatest_light = 1e12;
constexpr double greatest_depth = 3e4;  // extinction times the largest coordinate: places are rounded to 6e-8 of it
constexpr double greatest_g = 0.999, greatest_exponent = 1e4;

class Reasons {
 public:
  explicit Reasons(std::string what) : what_(std::move(what)) {}

  void within(const char* of, double value, double least, double greatest, const char* unit) {
    if (value == 0 || (value >= least && value <= greatest)) return;
    add(fmt::format("{} of {:.6g}{}, expected {:.6g} to {:.6g}", of, value, unit, least, greatest));
  }
  void size(const char* of, double value) { within(of, value, least_size, greatest_place, " m"); }
  void light(const Rgb& value) {
    for (const double v : {value.minCoeff(), value.maxCoeff()})
      within("light", std::abs(v), least_light, greatest_light, "");
  }
  void place(const Point3& x) {
    for (int i = 0; i < 3; ++i)
      if (std::isfinite(x[i])) within("coordinate", std::abs(x[i]), 0, greatest_place, " m");
  }
  void box(const Box& box) {
    if (box.empty()) return;
    place(box.lo), place(box.hi);
    size("side", box.size().minCoeff() == infinity ? 0 : box.size().minCoeff());
  }
  void add(const std::string& reason) {
    if (list_.empty()) list_.push_back(what_ + ": " + reason + " in single precision");
  }
  const std::vector<std::string>& list() const { return list_; }  // the first

 private:
  std::string what_;
  std::vector<std::string> list_;
};

template <class Lamp>
void look_at_lamp(Reasons& r, const Lamp& lamp) {
  r.place(lamp.position);
  r.size("radius", lamp.radius);
  r.light(lamp.intensity);
}

void look_at(Reasons& r, const Light& light) {
  match(
      light, [&](const PointLight& lamp) { look_at_lamp(r, lamp); },
      [&](const SpotLight& lamp) { look_at_lamp(r, lamp); },
      [&](const DirectionalLight& sun) { r.light(sun.irradiance); },
      [&](const EnvironmentLight& environment) { r.light(environment.scale); });
}

void look_at_voxels(Reasons& r, const VoxelGrid& grid) {
  r.size("voxel", grid.voxel_size);
  r.box(support(grid));
}

void look_at(Reasons& r, const DensityField& field) {
  match(
      field, [](const Homogeneous&) {},
      [&](const GaussianSum& sum) {
        for (const Gaussian& g : sum.gaussians) {
          r.place(g.center);
          r.size("width", g.width);
        }
      },
      [&](const GridPointer& grid) { look_at_voxels(r, *grid); },
      [&](const FogmapPointer& fog) {
        r.size("cell", fog->cell);
        for (const auto& [x, z] : ground_corners(*fog)) r.place({x, 0, z});
      },
      [&](const LegendrePointer& series) { r.box(series->box()); },
      [&](const FittedPointer& fitted) { look_at_voxels(r, fitted->grid); });
}

void look_at(Reasons& r, const PhaseFunction& phase) {
  match(
      phase, [](Isotropic) {}, [](Rayleigh) {},
      [&](HenyeyGreenstein hg) {
        if (std::abs(hg.g) > greatest_g) r.add(fmt::format("g = {}, expected at most {} in size", hg.g, greatest_g));
      },
      [](Hazy) {}, [](Murky) {});
}

void look_at(Reasons& r, const Medium& medium, const Point3& camera) {
  look_at(r, medium.field);
  const double density = greatest_density(medium.field);
  for (int c = 0; c < 3; ++c)
    r.within("extinction", medium.sigma_t[c] * density, least_extinction, greatest_extinction, " 1/m");
  double reach = camera.cwiseAbs().maxCoeff();
  const Box whole = bounding_box(medium);
  for (int i = 0; i < 3 && !whole.empty(); ++i)
    for (const double x : {whole.lo[i], whole.hi[i]})
      if (std::isfinite(x)) reach = std::max(reach, std::abs(x));
  r.within("extinction times the largest coordinate", medium.sigma_t.maxCoeff() * density * reach, 0, greatest_depth,
           "");
  if (!std::holds_alternative<Unbounded>(medium.region)) r.box(bounding_box(medium.region));
  look_at(r, medium.phase);
}

void look_at(Reasons& r, const Surface& surface) {
  match(
      surface.shape,
      [&](const TriangleMesh& mesh) {
        for (const Point3& x : mesh.vertices) r.place(x);
      },
      [&](const Sphere& sphere) { r.place(sphere.center), r.size("radius", sphere.radius); },
      [&](const Plane& plane) { r.place(plane.point); });
  match(
      surface.material, [](const Lambert&) {},
      [&](const Phong& phong) { r.within("exponent", phong.exponent, 0, greatest_exponent, ""); },
      [](const Tabulated&) {});
}

template <class List>
void look_at_all(std::vector<std::string>& reasons, const char* what, const List& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    Reasons r(fmt::format("{} {}", what, i));
    look_at(r, list[i]);
    reasons.insert(reasons.end(), r.list().begin(), r.list().end());
  }
}

}  // namespace

std::vector<std::string> beyond_single_precision(const Scene& scene) {
  std::vector<std::string> reasons;
  Reasons camera("camera"), ambient("ambient_in_scatter");
  camera.place(scene.camera.position);
  ambient.light(scene.ambient_in_scatter);
  for (const Reasons* r : {&camera, &ambient}) reasons.insert(reasons.end(), r->list().begin(), r->list().end());
  look_at_all(reasons, "light", scene.lights);
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    Reasons r(fmt::format("medium {}", i));
    look_at(r, scene.media[i], scene.camera.position);
    reasons.insert(reasons.end(), r.list().begin(), r.list().end());
  }
  look_at_all(reasons, "surface", scene.surfaces);
  return reasons;
}

}  // namespace airlight::scene
