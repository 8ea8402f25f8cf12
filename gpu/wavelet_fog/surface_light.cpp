#include "gpu/wavelet_fog/surface_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu/view_uniforms.h"
#include "scene/base/error.h"
#include "scene/light/scattered_lights.h"

namespace airlight::gpu::wavelet_fog {
namespace {

constexpr int most_nodes =
    12000;  // of the tree, with up to four triangles each: 65535 iterations of loops (gpu/README.md)

}  // namespace

void set_lamp(Program& p, const scene::Light& light) {
  const auto set = [&](int kind, const Point3& position, const Vec3& axis, const Rgb& colour) {
    p.set("lamp_kind", kind);
    p.set_double("lamp_position", position);
    p.set_double("lamp_axis", axis);
    p.set("lamp_colour", colour);
  };
  scene::match(
      light, [&](const scene::PointLight& lamp) { set(1, lamp.position, Vec3::UnitY(), lamp.intensity); },
      [&](const scene::SpotLight& lamp) {
        set(2, lamp.position, lamp.axis, lamp.intensity);
        p.set_double("lamp_cos_inner", std::cos(lamp.inner_angle));
        p.set_double("lamp_cos_outer", std::cos(lamp.outer_angle));
      },
      [&](const scene::DirectionalLight& sun) { set(0, Point3::Zero(), sun.to_light, sun.irradiance); },
      [](const scene::EnvironmentLight&) {});
}

bool something_ends_rays(const scene::Scene& scene) {
  return scene.geometry || std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
           const auto ball = scene::ball(light);
           return ball && ball->radius > 0;
         });
}

bool lamps_light_surfaces(const scene::Scene& scene) {
  const auto reaches = [](const scene::Light& light) { return scene::is_delta(light) && scene::shines(light); };
  return scene.geometry && std::any_of(scene.lights.begin(), scene.lights.end(), reaches);
}

SurfaceLight::SurfaceLight(Context& context, const scene::Scene& scene, const FirstHits* first_hits)
    : SurfaceLight(context, scene, first_hits, MaterialTables(scene)) {}

SurfaceLight::SurfaceLight(Context& context, const scene::Scene& scene, const FirstHits* first_hits,
                           const MaterialTables& tables)
    : first_hits_(first_hits),
      reflects_(lamps_light_surfaces(scene)),
      materials_(context, "materials", tables.materials),
      reflectances_(context, "tables of reflectances", tables.values),
      environments_(context, scene) {
  for (int i = 0; i < environments_.count(); ++i)
    backgrounds_.push_back(&program(context, "background", pixel_tile, pixel_tile, environments_.definitions(i)));
  if (!reflects_) return;
  if (context.software() && first_hits->tree().nodes() > most_nodes)
    throw Unavailable(fmt::format("gpu: {} nodes in the tree of surfaces, {} takes {} at most",
                                  first_hits->tree().nodes(), context.renderer(), most_nodes));
  surfaces_ = &program(context, "surfaces", pixel_tile, pixel_tile);
  if (const Box box = scene.geometry->bounds(); !box.empty())
    magnitude_ = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
  for (const scene::Surface& surface : scene.surfaces)
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape))
      magnitude_ = std::max(magnitude_, plane->point.cwiseAbs().maxCoeff());
}

bool SurfaceLight::become(const scene::Scene& scene) {
  return lamps_light_surfaces(scene) == reflects_ && environments_.become(scene);
}

void SurfaceLight::reflect(const scene::Light& light, const scene::View& view, const Buffer& primitives,
                           const Buffer& lit, bool first) {
  Program& p = *surfaces_;
  primitives.bind(at::primitives);
  materials_.bind(at::materials);
  reflectances_.bind(at::tables);
  lit.bind(at::lit);
  first_hits_->surfaces().bind();
  first_hits_->tree().bind(p);
  set_view(p, view);
  set_lamp(p, light);
  p.set("triangle_count", first_hits_->surfaces().triangles());
  p.set("first", first);
  p.set("loop_count", 3);
  // Offset of Geometry::offset_origin.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  p.dispatch(view.width, view.height);
}

void SurfaceLight::render(const scene::Scene& scene, const scene::View& view, const Buffer* primitives,
                          const Buffer& lit, const std::function<void(const scene::Light&)>& dim) {
  bool first = true;
  for (const scene::Light& light : scene.lights) {
    if (!reflects_ || !scene::is_delta(light)) continue;
    reflect(light, view, *primitives, lit, first);
    first = false;
    dim(light);
  }
  for (int i = 0; i < environments_.count(); ++i) {
    Program& p = *backgrounds_[i];
    (primitives ? *primitives : lit).bind(at::primitives);
    lit.bind(at::lit);
    environments_.bind(i, p);
    set_camera(p, view);
    p.set("has_primitives", primitives != nullptr);
    p.set("first", first);
    first = false;
    p.dispatch(view.width, view.height);
  }
}

}  // namespace airlight::gpu::wavelet_fog
