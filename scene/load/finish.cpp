// finish(): what a scene holds beside its description: the ray queries and the hash of its content.
#include <string>

#include "scene/base/content_key.h"
#include "scene/convert/residual_file.h"
#include "scene/finish_copy.h"
#include "scene/light/light_on_surface.h"
#include "scene/load/hash_parts.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::scene {
namespace {

using load::ContentHash;

// Names, file names and the order of keys do not change the picture and are not hashed. Members that a kind does not
// use (the height of a perspective camera) are not hashed either. Every structure is taken apart into all its members.
// A member that is added later therefore does not compile before this file says what it means for the hash.
void add(ContentHash& hash, const Camera& camera) {
  const auto& [kind, position, forward, right, up, vertical_fov, height] = camera;
  const bool perspective = kind == Camera::Kind::perspective;
  hash.tag(perspective ? "perspective" : "orthographic");
  hash.all(position, forward, right, up, perspective ? vertical_fov : height);
}

void add(ContentHash& hash, const PointLight& light) {
  const auto& [position, intensity, radius] = light;
  hash.all(position, intensity, radius);
}

void add(ContentHash& hash, const SpotLight& light) {
  const auto& [position, axis, inner_angle, outer_angle, intensity, radius] = light;
  hash.all(position, axis, inner_angle, outer_angle, intensity, radius);
}

void add(ContentHash& hash, const DirectionalLight& light) {
  const auto& [to_light, irradiance] = light;
  hash.all(to_light, irradiance);
}

void add(ContentHash& hash, const EnvironmentLight& light) {
  const auto& [scale, to_map, map, sh, tables, source] = light;  // tables follow from the others
  hash.all(scale, to_map);
  const EnvironmentMap none;
  const auto& [width, height, rgb] = map ? *map : none;
  hash.all(width, height);
  if (map) hash.add(rgb);
  hash.add(std::int64_t(sh.size()));
  for (const Rgb& coefficient : sh) hash.add(coefficient);
}

void add(ContentHash& hash, const Homogeneous& field) {
  const auto& [density] = field;
  hash.add(density);
}

void add(ContentHash& hash, const GaussianSum& field) {
  const auto& [gaussians, constant, cutoff] = field;
  hash.all(constant, cutoff, std::int64_t(gaussians.size()));
  for (const auto& [center, width, amplitude] : gaussians) hash.all(center, width, amplitude);
}

void add(ContentHash& hash, const std::shared_ptr<const VoxelGrid>& grid) { load::add(hash, *grid); }

void add(ContentHash&, const SameAtAllHeights&) {}

void add(ContentHash& hash, const Layers& layers) {
  const auto& [heights, factors] = layers;
  hash.all(heights, factors);
}

void add(ContentHash& hash, const ExponentialFall& fall) {
  const auto& [base, scale_height] = fall;
  hash.all(base, scale_height);
}

void add(ContentHash& hash, const std::shared_ptr<const Fogmap>& fog) {
  const auto& [map, profile, x0, z0, cell, cos_turn, sin_turn, note] = *fog;
  hash.add(map.degree());
  for (int axis = 0; axis < 2; ++axis) hash.all(map.range().lo[axis], map.range().size[axis]);
  hash.all(map.coefficients(), x0, z0, cell, cos_turn, sin_turn, int(profile.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, profile);
}

void add(ContentHash& hash, const std::shared_ptr<const LegendreBox>& field) {
  hash.add(field->box().lo);
  hash.add(field->box().hi);
  for (const int n : field->shape()) hash.add(n);
  hash.add(std::vector<double>(field->coefficients().begin(), field->coefficients().end()));
}

void add(ContentHash& hash, const FittedPointer& fitted) {
  const auto& [gaussians, residual, grid] = *fitted;
  add(hash, gaussians);
  load::add(hash, grid);
  hash.tag(residual ? content_key(residual_bytes(*residual)) : "no residual");
}

void add(ContentHash& hash, const Medium& medium) {
  const auto& [name, field, region, sigma_t, albedo, phase] = medium;
  hash.add(int(field.index()));
  std::visit([&](const auto& kind) { add(hash, kind); }, field);
  load::add(hash, region);
  hash.all(sigma_t, albedo);
  hash.tag(phase_name(phase));
  match(
      phase, [](Isotropic) {}, [](Rayleigh) {},
      [&](HenyeyGreenstein hg) {
        const auto& [g] = hg;
        hash.add(g);
      },
      [](Hazy) {}, [](Murky) {});
}

void add_surfaces(ContentHash& hash, const std::vector<Surface>& surfaces) {
  hash.tag("surfaces");
  hash.add(std::int64_t(surfaces.size()));
  for (const Surface& surface : surfaces) load::add(hash, surface);
}

void add_matter(ContentHash& hash, const std::vector<Medium>& media, const std::vector<Surface>& surfaces) {
  hash.tag("media");
  hash.add(std::int64_t(media.size()));
  for (const Medium& medium : media) add(hash, medium);
  add_surfaces(hash, surfaces);
}

void add_lights(ContentHash& hash, const std::vector<Light>& lights) {
  hash.tag("lights");
  hash.add(std::int64_t(lights.size()));
  for (const Light& light : lights) {
    hash.tag(light_name(light));
    std::visit([&](const auto& kind) { add(hash, kind); }, light);
  }
}

std::string matter_hash(const Scene& scene) {
  ContentHash hash;
  add_matter(hash, scene.media, scene.surfaces);
  return hash.digits();
}

std::string light_hash(const Scene& scene) {
  ContentHash hash;
  add_lights(hash, scene.lights);
  return hash.digits();
}

std::string surface_hash(const Scene& scene) {
  ContentHash hash;
  add_surfaces(hash, scene.surfaces);
  return hash.digits();
}

std::string content_hash(const Scene& scene) {
  ContentHash hash;
  hash.tag("airlight scene 1");  // raised when the meaning of the values changes
  // The geometry follows from the surfaces.
  const auto& [name, camera, width, height, lights, media, surfaces, geometry, backdrops, ambient_in_scatter, whole,
               of_matter, of_lights, of_surfaces] = scene;
  hash.all(width, height, ambient_in_scatter);
  add(hash, camera);
  add_lights(hash, lights);
  add_matter(hash, media, surfaces);
  for (const auto& one : backdrops) {
    const auto& [columns, rows, radiance, depth, fills] = *one;
    hash.tag(fills ? "backdrop" : "particles");
    hash.all(columns, rows, radiance, depth);
  }
  return hash.digits();
}

}  // namespace

void finish(Scene& scene) {
  scene.geometry = scene.surfaces.empty() ? nullptr : std::make_shared<const Geometry>(scene.surfaces);
  scene.surface_hash = surface_hash(scene);
  finish_copy(scene);
}

void finish_copy(Scene& scene) {
  move_camera_off_surfaces(scene);
  move_lights_off_surfaces(scene);
  scene.hash = content_hash(scene);
  scene.matter_hash = matter_hash(scene);
  scene.light_hash = light_hash(scene);
}

}  // namespace airlight::scene
