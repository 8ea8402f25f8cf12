// Backdrops and particles of a scene on the device: scene::camera_end for what is no surface, for every pixel centre.
#pragma once
#include <memory>
#include <vector>

#include "gpu/program.h"
#include "gpu/raster/raster_pass.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class Backdrops {
 public:
  // Uploads. Throws Unavailable where the device has no room for them.
  Backdrops(Context&, const scene::Scene&);

  // For every pixel centre. Row 0 first, x fastest. `distances` [m along the rays], which end what surfaces do (`known`) or nothing, become those of backdrops
  // where these are nearer; `seen`, 3 floats a pixel, what they send from there [W/m^2/sr], -1 where none is seen. Primitives of
  // FirstHits, unless null, become -1 there. Throws Error for a view that is not through the scene's own camera.
  void find(const scene::View&, const Buffer& distances, bool known, const Buffer& seen,
            const Buffer* primitives = nullptr) const;
  // Distances alone, for the rays of a grid.
  void find(const scene::View&, const Buffer& distances, bool known, const CellGrid&) const;

 private:
  void find(const scene::View&, const Buffer& distances, bool known, const Buffer* seen, const Buffer* primitives,
            const CellGrid&) const;
  struct Picture {
    int width, height;
    bool fills;
    Buffer depth, radiance;
    Picture(Context&, const scene::Backdrop&);
  };
  const scene::Scene& scene_;
  Program& program_;
  std::vector<std::unique_ptr<Picture>> pictures_;
};

}  // namespace airlight::gpu
