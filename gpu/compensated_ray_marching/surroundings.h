// Objects in and behind the smoke: ends of camera rays, environments, and surfaces lit from directions.
#pragma once
#include <memory>
#include <vector>

#include "gpu/compensated_ray_marching/interface.h"
#include "gpu/environment_lights.h"
#include "gpu/frame.h"
#include "gpu/raster/backdrops.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/compensated_ray_marching/incoming_light.h"

namespace airlight::gpu::compensated_ray_marching {

class Surroundings {
 public:
  Surroundings(Context&, const scene::Scene&);
  // Other lights of the same scene.
  void become(const scene::Scene&);
  // Surfaces are lit from the directions that smoke is lit from, one after the other; where they are not, light_surfaces is not called.
  void set_lamps(const scene::Scene&, const airlight::compensated_ray_marching::IncomingLight&);

  const EnvironmentLights& environments() const { return *environments_; }
  const FirstHits* surfaces() const { return first_hits_.get(); }  // null: there are none
  bool backdrops() const { return bool(backdrops_); }
  bool ends() const { return first_hits_ || backdrops_; }
  bool behind() const { return environments_->count() > 0; }
  std::size_t lamps() const { return lamps_.lights.size(); }

  // Into buffers of the frame: "distances" [m] and with surfaces "primitives", "seen" of backdrops; "lit", of which `dim` takes what smoke
  // takes; "surface".
  void find_ends(const scene::View&, Frame&) const;
  void light_surfaces(const scene::View&, Frame&, const std::function<void(const scene::Light&)>& dim) const;
  void look_behind(const scene::View&, Frame&) const;

 private:
  void set_environments(const scene::Scene&);

  Context& context_;
  std::unique_ptr<EnvironmentLights> environments_;
  std::unique_ptr<FirstHits> first_hits_;
  std::unique_ptr<Backdrops> backdrops_;
  std::unique_ptr<wavelet_fog::SurfaceLight> surfaces_;
  scene::Scene lamps_;            // the surfaces, lit from directions
  std::vector<Program*> behind_;  // for each environment
};

// A buffer of the frame that holds so many bytes for every pixel.
inline Buffer& of_pixels(Frame& frame, const char* name, const scene::View& view, std::size_t bytes) {
  return frame.buffers.get(name, bytes * std::size_t(view.width) * std::size_t(view.height));
}

}  // namespace airlight::gpu::compensated_ray_marching
