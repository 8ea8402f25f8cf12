// Optical depths from points towards lights, as columns.glsl has them, and the lights themselves.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/light_map/light_maps.h"
#include "gpu/ray_marcher/media.h"
#include "gpu/timer.h"
#include "reference/ray_marcher/options.h"

namespace airlight::gpu::ray_marcher {

class Columns {
 public:
  // How media dim light on its way to a point: not at all, by columns of steps, by what maps of the lights hold, or by
  // columns without steps. The numbers are DEPTHS of the shaders.
  enum class Depths { none, columns, maps, exact };

  // Uploads, and makes the maps, the timer's stages "upload" (ended here) and "light_maps". `lights` in the order of the
  // device (balls_first); the media are kept by reference. Throws
  // Unavailable where the device has no room, Interrupted if `progress` says so.
  Columns(Context&, const MediaOnDevice&, const std::vector<scene::Medium>&,
          const std::vector<airlight::ray_marcher::Layer>&, const std::vector<scene::Light>& lights, Depths,
          const airlight::light_map::Options&, StageTimer&, const std::function<bool(double)>& progress);

  // Do programs and buffers for these lights and maps serve those?
  bool is_like(const std::vector<scene::Medium>&, const std::vector<scene::Light>& lights, Depths) const;
  // Becomes such lights, and draws the maps that are not kept (LightMaps::become): how many, the timer's stage "light_maps".
  int become(const MediaOnDevice&, const std::vector<scene::Medium>&, const std::vector<airlight::ray_marcher::Layer>&,
             const std::vector<scene::Light>& lights, bool same_media, StageTimer&,
             const std::function<bool(double)>& progress);

  Depths depths() const { return depths_; }
  const light_map::LightMaps* maps() const { return maps_.get(); }  // null: there are none
  // Definitions for a program that includes columns.glsl: DEPTHS; for maps those of look_up.glsl, and for exact columns of
  // Legendre boxes those of sign_changes.glsl.
  std::map<std::string, std::string> definitions() const;
  // Binds storage blocks 0 (maps) and 4 (lights) and uniform block 1 (exact columns), sets the uniforms. Maps do not
  // read `options`.
  void bind(LinkedProgram&, const airlight::ray_marcher::Options& options = {}) const;

 private:
  Depths depths_;
  std::size_t count_;
  std::vector<char> lights_uploaded_;
  Buffer lights_;
  std::unique_ptr<light_map::LightMaps> maps_;
  int points_;  // on a ray through a Legendre box, for exact columns; 0: there is none
  std::unique_ptr<Buffer> rule_;
};

}  // namespace airlight::gpu::ray_marcher
