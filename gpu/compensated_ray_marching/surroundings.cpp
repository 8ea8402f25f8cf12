#include "gpu/compensated_ray_marching/surroundings.h"

#include "gpu/view_uniforms.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {}  // namespace

Surroundings::Surroundings(Context& context, const scene::Scene& scene) : context_(context) {
  set_environments(scene);
  if (!scene.backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context_, scene);
  if (scene.geometry) first_hits_ = std::make_unique<FirstHits>(context_, scene);
}

void Surroundings::set_environments(const scene::Scene& scene) {
  environments_ = std::make_unique<EnvironmentLights>(context_, scene);
  behind_.clear();
  for (int l = 0; l < environments_->count(); ++l)
    behind_.push_back(&program(context_, "smoke_behind", pixel_tile, pixel_tile, environments_->definitions(l)));
}

void Surroundings::become(const scene::Scene& scene) {
  if (!environments_->become(scene)) set_environments(scene);
}

void Surroundings::set_lamps(const scene::Scene& scene,
                             const airlight::compensated_ray_marching::IncomingLight& incoming) {
  if (!surfaces_) {
    lamps_ = scene;
    lamps_.lights = {scene::DirectionalLight{}};  // its programs are wanted even when no direction has light yet
    surfaces_ = std::make_unique<wavelet_fog::SurfaceLight>(context_, lamps_, first_hits_.get());
  }
  lamps_.lights.clear();
  for (std::size_t k = 0; k < incoming.directions().size(); ++k)
    if ((incoming.power()[k] != 0).any())
      lamps_.lights.push_back(scene::DirectionalLight{incoming.directions()[k], incoming.power()[k]});
}

void Surroundings::find_ends(const scene::View& view, Frame& frame) const {
  const Buffer& distances = of_pixels(frame, "distances", view, 4);
  if (first_hits_) {
    const Buffer& primitives = of_pixels(frame, "primitives", view, 4);
    first_hits_->find(view, distances, &primitives);
  }
  if (backdrops_) backdrops_->find(view, distances, bool(first_hits_), of_pixels(frame, "seen", view, 12));
}

void Surroundings::look_behind(const scene::View& view, Frame& frame) const {
  of_pixels(frame, "surface", view, 12).bind(at::surface_layer);
  for (int l = 0; l < environments_->count(); ++l) {
    Program& p = *behind_[std::size_t(l)];
    set_camera(p, view);
    environments_->bind(l, p);
    p.set("first", l == 0);
    (first_hits_ ? of_pixels(frame, "primitives", view, 4) : of_pixels(frame, "surface", view, 12))
        .bind(at::primitives);
    p.set("has_primitives", bool(first_hits_));
    p.dispatch(view.width, view.height);
  }
}

void Surroundings::light_surfaces(const scene::View& view, Frame& frame,
                                  const std::function<void(const scene::Light&)>& dim) const {
  Buffer& lit = of_pixels(frame, "lit", view, sizeof(wavelet_fog::LitData));
  if (lamps_.lights.empty()) lit.clear();
  surfaces_->render(lamps_, view, &of_pixels(frame, "primitives", view, 4), lit, dim);
}

}  // namespace airlight::gpu::compensated_ray_marching
