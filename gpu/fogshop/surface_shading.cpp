#include "gpu/fogshop/surface_shading.h"

#include <algorithm>
#include <limits>

#include "gpu/view_uniforms.h"

namespace airlight::gpu {
namespace {

std::vector<double> light_places(const fogshop::Model& model) {
  std::vector<double> places;
  for (const fogshop::LightModel& light : model.lights)
    places.insert(places.end(), light.position.data(), light.position.data() + 3);
  return places;
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

bool casts_shadows(const scene::Scene& scene, const fogshop::Model& model) {
  return !model.lights.empty() &&
         (scene.surfaces.size() > 1 ||
          (scene.surfaces.size() == 1 && std::holds_alternative<scene::TriangleMesh>(scene.surfaces.front().shape)));
}

SurfaceShading::SurfaceShading(Context& context, const scene::Scene& scene, const fogshop::Model& model,
                               const fogshop::SurfaceLighting& lighting)
    : context_(context),
      scene_(scene),
      model_(model),
      lighting_(lighting),
      magnitude_(magnitude(scene)),
      places_(scene, lighting),
      materials_(context, "materials", places_.materials),
      light_places_(context, "light positions", light_places(model)),
      tables_(context, "tables of surfaces", places_.values),
      transfer_(context, "radiance transfer", places_.transfer) {
  // On the device by now.
  places_.materials.clear();
  places_.values.clear();
  places_.transfer.clear();
}

void SurfaceShading::fill_light_distances(int side) {
  std::vector<Point3> positions;
  for (const fogshop::LightModel& light : model_.lights) positions.push_back(light.position);
  maps_ = std::make_unique<LightDistances>(context_, scene_, positions, side);
  tree_ = std::make_unique<ShadowTree>(context_, scene_);
}

void SurfaceShading::shade(FogOnDevice& fog, const SurfacesOnDevice& surfaces, const scene::View& view,
                           const Buffer& primitives, const Buffer* pixels, const Buffer& surface,
                           const Buffer* scattered) {
  const Use use(context_);
  const bool sun = lighting_.points && lighting_.points->sun();
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  Program& p = fog.program("fogshop/surfaces.comp", {{"LOCAL_SIZE_X", "8"},
                                                     {"LOCAL_SIZE_Y", "8"},
                                                     {"SH_ORDER", std::to_string(model_.options.sh_order)},
                                                     {"HARMONICS", flag(lighting_.reflectances != nullptr)},
                                                     {"TRANSFER", flag(lighting_.transfer != nullptr)},
                                                     {"ENVIRONMENT", flag(lighting_.environment != nullptr)},
                                                     {"SUN", flag(sun)}});
  fog.bind();
  surfaces.bind();
  materials_.bind(2);
  light_places_.bind(3);
  tables_.bind(9);
  if (lighting_.transfer) transfer_.bind(13);
  primitives.bind(1);
  if (maps_) {
    maps_->primitives().bind(5);
    tree_->bind(p);
  }
  if (pixels) pixels->bind(6);
  surface.bind(7);
  if (scattered) scattered->bind(8);
  set_view(p, view);
  p.set("light_count", int(model_.lights.size()));
  p.set("triangle_count", surfaces.triangles());
  p.set("loop_count", 3);
  p.set("map_side", maps_ ? maps_->side() : 0);
  p.set("has_airlight", pixels != nullptr);
  p.set("has_scattered", scattered != nullptr);
  for (const auto& [name, place] : places_.uniforms) p.set(name, place);
  if (lighting_.reflectances) {
    p.set("sh_order", model_.options.sh_order);
    p.set("least_depth", fogshop::PsfBands::least_depth);
    p.set("greatest_depth", fogshop::PsfBands::greatest_depth);
  }
  const double constant = model_.fog.sum.constant;
  p.set("environment_depth", constant > 0 ? constant * model_.options.environment_distance : 0.0);
  // As Geometry::offset_origin: 32 ulp of the largest coordinate, of what is seen too.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  check_iterations(context_,
                   double(model_.lights.size()) * (model_.gaussians.count + 60 + places_.light_iterations) +
                       places_.iterations + (lighting_.environment ? model_.gaussians.count : 0),
                   "light on surfaces");
  p.dispatch(view.width, view.height);
}

}  // namespace airlight::gpu
