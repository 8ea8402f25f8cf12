#include "gpu/fogshop/surface_shading.h"

#include <algorithm>
#include <limits>

#include "gpu/raster/view_uniforms.h"
#include "scene/error.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::gpu {
namespace {

using fogshop::ScatteredReflection;

constexpr int cosines = 16, most_bands = 12;  // as fogshop/reflection.glsl

struct MaterialData {
  std::array<float, 4> diffuse, specular;
};

std::array<float, 4> float4(const Rgb& color, double w) {
  return {float(color[0]), float(color[1]), float(color[2]), float(w)};
}
MaterialData data_of(const scene::Lambert& m) { return {float4(m.albedo, 0), float4(Rgb::Zero(), 0)}; }
MaterialData data_of(const scene::Phong& m) { return {float4(m.diffuse, 1), float4(m.specular, m.exponent)}; }
// FogshopGpu::supports refuses it.
MaterialData data_of(const scene::Tabulated&) { throw Error("a tabulated reflectance is for the CPU"); }

std::vector<MaterialData> material_data(const scene::Scene& scene) {
  std::vector<MaterialData> data;
  for (const scene::Surface& surface : scene.surfaces)
    data.push_back(std::visit([](const auto& material) { return data_of(material); }, surface.material));
  return data;
}

std::vector<double> light_places(const fogshop::Model& model) {
  std::vector<double> places;
  for (const fogshop::LightModel& light : model.lights)
    places.insert(places.end(), light.position.data(), light.position.data() + 3);
  return places;
}

std::vector<float> harmonics(const ScatteredReflection* reflection, int order) {
  if (!reflection) return {};
  std::vector<float> values;
  const scene::GaussLegendre rule = scene::gauss_legendre(cosines);
  for (const double x : rule.node) values.push_back(float(0.5 * (1 + x)));
  for (const double w : rule.weight) values.push_back(float(0.5 * w));
  // One band alone, straight from above, on a white Lambert surface.
  for (int l = 0; l < most_bands; ++l) {
    std::vector<double> one(l + 1, 0.0);
    one[l] = 1;
    const Vec3 up = Vec3::UnitZ();
    values.push_back(float(pi * ScatteredReflection::reflect(scene::Lambert{Rgb::Ones()}, up, up, up, one)[0]));
  }
  for (const double T : reflection->depths()) {
    const std::vector<double> g = reflection->bands(T);
    for (int l = 0; l < order; ++l) values.push_back(float(g[l]));
  }
  return values;
}

double magnitude(const scene::Scene& scene) {
  double most = 0;
  if (const Box box = scene.geometry->bounds(); !box.empty())
    most = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
  for (const scene::Surface& surface : scene.surfaces)
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape))
      most = std::max(most, plane->point.cwiseAbs().maxCoeff());
  return most;
}

}  // namespace

bool casts_shadows(const scene::Scene& scene) {
  return scene.surfaces.size() > 1 ||
         (scene.surfaces.size() == 1 && std::holds_alternative<scene::TriangleMesh>(scene.surfaces.front().shape));
}

SurfaceShading::SurfaceShading(Context& context, const scene::Scene& scene, const fogshop::Model& model,
                               const ScatteredReflection* reflection)
    : context_(context),
      scene_(scene),
      model_(model),
      magnitude_(magnitude(scene)),
      scattered_(reflection != nullptr),
      materials_(context, "materials", material_data(scene)),
      light_places_(context, "light positions", light_places(model)),
      harmonics_(context, "harmonics", harmonics(reflection, model.options.sh_order)) {}

void SurfaceShading::fill_light_distances(int side) {
  std::vector<Point3> positions;
  for (const fogshop::LightModel& light : model_.lights) positions.push_back(light.position);
  maps_ = std::make_unique<LightDistances>(context_, scene_, positions, side);
}

void SurfaceShading::shade(FogOnDevice& fog, const SurfacesOnDevice& surfaces, const scene::View& view,
                           const Buffer& primitives, const Buffer* pixels, const Buffer& surface,
                           const Buffer* scattered) {
  const Use use(context_);
  Program& p = fog.program("fogshop/surfaces.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
  fog.bind();
  surfaces.bind();
  materials_.bind(2);
  light_places_.bind(3);
  harmonics_.bind(9);
  primitives.bind(1);
  if (maps_) {
    maps_->primitives().bind(5);
    maps_->distances().bind(14);
  }
  if (pixels) pixels->bind(6);
  surface.bind(7);
  if (scattered) scattered->bind(8);
  set_view(p, view);
  p.set("light_count", int(model_.lights.size()));
  p.set("triangle_count", surfaces.triangles());
  p.set("map_side", maps_ ? maps_->side() : 0);
  p.set("has_airlight", pixels != nullptr);
  p.set("has_scattered", scattered_ && scattered);
  p.set("sh_order", model_.options.sh_order);
  p.set("depth_entries",
        model_.options.reflectance == fogshop::Options::Reflectance::npsf_by_depth ? fogshop::PsfBands::entries : 1);
  p.set("least_depth", fogshop::PsfBands::least_depth);
  p.set("greatest_depth", fogshop::PsfBands::greatest_depth);
  // As Geometry::offset_origin: 32 ulp of the largest coordinate, of what is seen too.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  const bool lobes = std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), [](const scene::Surface& each) {
    return std::holds_alternative<scene::Phong>(each.material);
  });
  const double directions = scattered_ && scattered && lobes ? cosines * (1 + 32.0 * (1 + model_.options.sh_order)) : 0;
  check_iterations(context_, double(model_.lights.size()) * (model_.gaussians.count + directions + 60),
                   "light on surfaces");
  p.dispatch(view.width, view.height);
}

}  // namespace airlight::gpu
