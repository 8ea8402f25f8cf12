// The ends of a scene's camera rays on the device, and the initial layers of the film.
#pragma once
#include <memory>
#include <vector>

#include "gpu/frame.h"
#include "gpu/raster/backdrops.h"
#include "gpu/raster/first_hits.h"

namespace airlight::gpu::ray_marcher {

// Layers of a film on the device, 3 floats a pixel, and what ends its rays. Null: nothing does.
struct FilmOnDevice {
  const Buffer *distances = nullptr, *primitives = nullptr;
  const Buffer* seen = nullptr;  // what backdrops send (gpu/raster/backdrops.h)
  const Buffer &airlight, &transmittance, &surface, &mean;
};

class RayEnds {
 public:
  // Uploads; keeps the scene by reference. Throws Unavailable where the device has no room.
  RayEnds(Context&, const scene::Scene&, FirstHits::Way = FirstHits::Way::tree);

  // Takes over balls of lights that have moved, where surfaces are the same. False, and nothing is done: there are other surfaces,
  // backdrops, or another number of balls.
  bool become(const scene::Scene& before, const scene::Scene&);

  const FirstHits* surfaces() const { return surfaces_.get(); }    // and balls of lights; null: there are none
  const Backdrops* backdrops() const { return backdrops_.get(); }  // null: there are none
  // "distances" and "backdrops", for `explain`.
  std::vector<scene::Stage> stages() const;

  // The frame's buffers of the layers, noted for the download, and what ends the rays: the stages "distances" and "backdrops".
  FilmOnDevice begin_film(const scene::View&, Frame&) const;

 private:
  std::unique_ptr<FirstHits> surfaces_;
  std::unique_ptr<Backdrops> backdrops_;
};

// Is there anything behind media that is lit or shines? `lights`: those that shine from one direction.
bool something_behind(const scene::Scene&, std::size_t lights);

// Numbers that came down as low and high words; none where nothing did.
std::vector<double> totals_of(const Download&, const std::string& name);

// The film where nothing is to be done: no medium, nothing behind it.
void clear_film(scene::Rendering&, const scene::Execution&);

}  // namespace airlight::gpu::ray_marcher
