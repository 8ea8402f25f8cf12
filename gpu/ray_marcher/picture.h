// The film from what is known of its pixels (pixel.glsl): surfaces and environments behind the media, then the layers. The marcher
// fills the pixels, and so do renderers of other folders.
#pragma once
#include <functional>
#include <vector>

#include "gpu/environment_lights.h"
#include "gpu/frame.h"
#include "gpu/material_tables.h"
#include "gpu/raster/first_hits.h"
#include "gpu/ray_marcher/columns.h"
#include "gpu/ray_marcher/rounds.h"

namespace airlight::gpu::ray_marcher {

// Layers of a film on the device, 3 floats a pixel, and what ends its rays. Null: nothing does.
struct FilmOnDevice {
  const Buffer *distances = nullptr, *primitives = nullptr;
  const Buffer* seen = nullptr;  // what backdrops send (gpu/raster/backdrops.h)
  const Buffer &airlight, &transmittance, &surface, &mean;
  const Buffer& totals;  // low and high words of steps, shadow rays or look-ups, shadow steps, occlusion rays
};

// Rows of the image whose pixels' state is on the device at once.
struct Band {
  int first_row, rows;
  const Buffer& pixels;
};

class Picture {
 public:
  // Keeps all by reference but the lights, of which it takes the number. `columns`: null where no light has a direction. `options`
  // of marched columns.
  Picture(Context&, const scene::Scene&, const MediaOnDevice&, const Columns*, int lights,
          const airlight::ray_marcher::Options&, const FirstHits*);

  // For each band: what `fill` does to its pixels, the stages "surfaces" and "composition". `has_media`: is there a fill? `counts`:
  // the totals are wanted. `looks` as in Rounds. Throws scene::Interrupted if `progress` says so.
  void render(const scene::View&, const FilmOnDevice&, Frame&, const std::function<void(const Band&)>& fill,
              bool counts, bool looks, const std::function<bool(double)>& progress);
  // Rounds::note and Rounds::unfinished.
  void note(Download& download) const { rounds_.note(download); }
  bool unfinished(const Download& download) const { return rounds_.unfinished(download); }

 private:
  Picture(Context&, const scene::Scene&, const MediaOnDevice&, const Columns*, int lights,
          const airlight::ray_marcher::Options&, const FirstHits*, const MaterialTables&);
  void reflect(const scene::View&, const FilmOnDevice&, FrameBuffers&, const Band&);
  void add_environments(const scene::View&, const FilmOnDevice&, const Band&);
  void compose(const scene::View&, const FilmOnDevice&, const Band&, bool has_media, bool counts);

  const MediaOnDevice& media_;
  const Columns* columns_;
  int lights_;
  const airlight::ray_marcher::Options& options_;
  const FirstHits* first_hits_;
  double magnitude_ = 0;  // largest coordinate of what is seen [m]
  Buffer materials_, reflectances_;
  EnvironmentLights environments_;
  Program *surfaces_ = nullptr, *composition_ = nullptr;  // null: left out
  std::vector<Program*> backgrounds_;                     // by environment
  Rounds rounds_;
};

}  // namespace airlight::gpu::ray_marcher
