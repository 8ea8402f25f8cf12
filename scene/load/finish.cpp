// finish(): what a scene holds beside its description: the ray queries and the hash of its content.
#include <string>

#include "scene/content_key.h"
#include "scene/convert/residual_file.h"
#include "scene/light_on_surface.h"
#include "scene/load/hash_parts.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::scene {
namespace {

using load::ContentHash;

// Names, file names and the order of keys do not change the picture and are left out. What one kind does not use (the
// height of a perspective camera) is left out too.
void add(ContentHash& hash, const Camera& camera) {
  const bool perspective = camera.kind == Camera::Kind::perspective;
  hash.tag(perspective ? "perspective" : "orthographic");
  hash.add(camera.position);
  hash.add(camera.forward);
  hash.add(camera.right);
  hash.add(camera.up);
  hash.add(perspective ? camera.vertical_fov : camera.height);
}

void add(ContentHash& hash, const PointLight& light) {
  hash.add(light.position);
  hash.add(light.intensity);
  hash.add(light.radius);
}

void add(ContentHash& hash, const SpotLight& light) {
  hash.add(light.position);
  hash.add(light.axis);
  hash.add(light.inner_angle);
  hash.add(light.outer_angle);
  hash.add(light.intensity);
  hash.add(light.radius);
}

void add(ContentHash& hash, const DirectionalLight& light) {
  hash.add(light.to_light);
  hash.add(light.irradiance);
}

void add(ContentHash& hash, const EnvironmentLight& light) {
  hash.add(light.scale);
  hash.add(light.to_map);
  hash.add(light.map ? light.map->width : 0);
  hash.add(light.map ? light.map->height : 0);
  if (light.map) hash.add(light.map->rgb);
  hash.add(std::int64_t(light.sh.size()));
  for (const Rgb& coefficient : light.sh) hash.add(coefficient);
}

void add(ContentHash& hash, const Homogeneous& field) { hash.add(field.density); }

void add(ContentHash& hash, const GaussianSum& field) {
  hash.add(field.constant);
  hash.add(field.cutoff);
  hash.add(std::int64_t(field.gaussians.size()));
  for (const Gaussian& g : field.gaussians) {
    hash.add(g.center);
    hash.add(g.width);
    hash.add(g.amplitude);
  }
}

void add(ContentHash& hash, const std::shared_ptr<const VoxelGrid>& grid) { load::add(hash, *grid); }

void add(ContentHash&, const SameAtAllHeights&) {}

void add(ContentHash& hash, const Layers& layers) {
  hash.add(layers.heights);
  hash.add(layers.factors);
}

void add(ContentHash& hash, const ExponentialFall& fall) {
  hash.add(fall.base);
  hash.add(fall.scale_height);
}

void add(ContentHash& hash, const std::shared_ptr<const Fogmap>& fog) {
  hash.add(fog->map.degree());
  for (int axis = 0; axis < 2; ++axis) {
    hash.add(fog->map.range().lo[axis]);
    hash.add(fog->map.range().size[axis]);
  }
  hash.add(fog->map.coefficients());
  for (const double value : {fog->x0, fog->z0, fog->cell, fog->cos_turn, fog->sin_turn}) hash.add(value);
  hash.add(int(fog->profile.index()));
  std::visit([&](const auto& profile) { add(hash, profile); }, fog->profile);
}

void add(ContentHash& hash, const std::shared_ptr<const LegendreBox>& field) {
  hash.add(field->box().lo);
  hash.add(field->box().hi);
  for (const int n : field->shape()) hash.add(n);
  hash.add(std::vector<double>(field->coefficients().begin(), field->coefficients().end()));
}

void add(ContentHash& hash, const FittedPointer& fitted) {
  add(hash, fitted->gaussians);
  load::add(hash, fitted->grid);
  hash.tag(fitted->residual ? content_key(residual_bytes(*fitted->residual)) : "no residual");
}

void add(ContentHash& hash, const Medium& medium) {
  hash.add(int(medium.field.index()));
  std::visit([&](const auto& field) { add(hash, field); }, medium.field);
  load::add(hash, medium.region);
  hash.add(medium.sigma_t);
  hash.add(medium.albedo);
  hash.tag(phase_name(medium.phase));
  match(
      medium.phase, [](Isotropic) {}, [](Rayleigh) {}, [&](HenyeyGreenstein hg) { hash.add(hg.g); }, [](Hazy) {},
      [](Murky) {});
}

void add_matter(ContentHash& hash, const Scene& scene) {
  hash.tag("media");
  hash.add(std::int64_t(scene.media.size()));
  for (const Medium& medium : scene.media) add(hash, medium);
  hash.tag("surfaces");
  hash.add(std::int64_t(scene.surfaces.size()));
  for (const Surface& surface : scene.surfaces) load::add(hash, surface);
}

std::string matter_hash(const Scene& scene) {
  ContentHash hash;
  add_matter(hash, scene);
  return hash.digits();
}

std::string content_hash(const Scene& scene) {
  ContentHash hash;
  hash.tag("airlight scene 1");  // raised when the meaning of the values changes
  hash.add(scene.width);
  hash.add(scene.height);
  hash.add(scene.ambient_in_scatter);
  add(hash, scene.camera);
  hash.tag("lights");
  hash.add(std::int64_t(scene.lights.size()));
  for (const Light& light : scene.lights) {
    hash.tag(light_name(light));
    std::visit([&](const auto& kind) { add(hash, kind); }, light);
  }
  add_matter(hash, scene);
  for (const auto& backdrop : scene.backdrops) {
    hash.tag(backdrop->fills ? "backdrop" : "particles");
    hash.add(backdrop->width);
    hash.add(backdrop->height);
    hash.add(backdrop->radiance);
    hash.add(backdrop->depth);
  }
  return hash.digits();
}

}  // namespace

void finish(Scene& scene) {
  scene.geometry = scene.surfaces.empty() ? nullptr : std::make_shared<const Geometry>(scene.surfaces);
  move_camera_off_surfaces(scene);
  move_lights_off_surfaces(scene);
  scene.hash = content_hash(scene);
  scene.matter_hash = matter_hash(scene);
}

}  // namespace airlight::scene
