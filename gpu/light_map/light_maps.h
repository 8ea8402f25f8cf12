// Maps of the optical depth towards lights (reference/light_map), made on the device and kept there: all lights' in one storage
// buffer, which look_up.glsl reads.
//
// Depths of steps are computed first, many invocations a texel, and then encoded, one a texel: so no invocation loops over all steps
// and all Gaussians.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/ray_marcher/media.h"
#include "reference/light_map/light_map.h"

namespace airlight::gpu::light_map {

class LightMaps {
 public:
  // Makes the maps of lights that shine from one direction. `layers` are those of the media on the device, made of `in_scene`. Throws
  // Unavailable where a storage buffer of the device is too small for all, Interrupted if `progress` says so.
  LightMaps(Context&, const ray_marcher::MediaOnDevice&, const std::vector<scene::Medium>& in_scene,
            const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>&,
            const airlight::light_map::Options&, const std::function<bool(double)>& progress);

  // Do buffers for these maps serve as many lights in these media?
  bool fits(const std::vector<scene::Medium>& in_scene, const std::vector<scene::Light>&) const;
  // Becomes the maps of such lights: draws those that are not kept, and keeps a light's map where its rays are the same and no medium has
  // changed (`same_media`). How many were drawn. From now on, keeps what maps are drawn with, too.
  int become(const ray_marcher::MediaOnDevice&, const std::vector<scene::Medium>& in_scene,
             const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>&, bool same_media,
             const std::function<bool(double)>& progress);

  // For a program that includes look_up.glsl.
  std::map<std::string, std::string> definitions() const;
  // Binds storage block 0, sets the uniforms.
  void bind(LinkedProgram&) const;
  int planes() const { return varied_.planes; }  // optical depths of a texel: 0, 1 or 3
  std::size_t bytes() const { return buffer_.bytes(); }

  // The floats of light l's plane, row by row with the border of one texel. Waits for the device: for tests.
  std::vector<float> texels(int light, int plane) const;

 private:
  struct Part;
  // Working memory: steps of a light's rays, nodes of curves, parts of media, and waves.
  struct Work {
    std::unique_ptr<Buffer> steps, nodes, parts, waves;
  };
  void project(const std::vector<scene::Light>&);
  // Makes the maps of the lights for which `wanted` is set.
  void make(const ray_marcher::MediaOnDevice&, const std::vector<airlight::ray_marcher::Layer>&,
            const std::vector<bool>& wanted, Work&, const std::function<bool(double)>& progress);
  std::vector<float> rules(const Point3& middle) const;
  std::vector<Part> parts(const ray_marcher::MediaOnDevice&, const std::vector<airlight::ray_marcher::Layer>&) const;
  std::size_t plane_floats() const;

  Context& context_;
  airlight::light_map::Options options_;
  airlight::light_map::VariedMedia varied_;
  std::vector<airlight::light_map::Projection> projections_;  // by light; none where nothing varies
  std::vector<scene::Light> drawn_;                           // whose maps these are
  int lights_;
  Buffer buffer_;
  Work work_;  // kept by become()
};

}  // namespace airlight::gpu::light_map
