// The film from what is known of its pixels (pixel.glsl): surfaces and environments behind the media, then the layers. The marcher
// fills the pixels, and so do renderers of other folders.
#pragma once
#include <functional>
#include <vector>

#include "gpu/environment_lights.h"
#include "gpu/frame.h"
#include "gpu/material_tables.h"
#include "gpu/ray_marcher/columns.h"
#include "gpu/ray_marcher/ray_ends.h"
#include "gpu/ray_marcher/rounds.h"

namespace airlight::gpu::ray_marcher {

// Rows of the image whose pixels' state is on the device at once.
struct Band {
  int first_row, rows;
  const Buffer& pixels;
};

class Picture {
 public:
  // Keeps all by reference; `lights` is their number. `options` of marched columns.
  Picture(Context&, const scene::Scene&, const MediaOnDevice&, const Columns&, int lights,
          const airlight::ray_marcher::Options&, const FirstHits*);

  // Environments of the next frame, among the same surfaces. False, and nothing is done: other maps, or lights of another kind.
  bool become(const scene::Scene& scene) { return environments_.become(scene); }

  // For each band: what `fill` does to its pixels (null: there are no media), the stages "surfaces" and "composition". `totals`:
  // null, or where low and high words of the pixels' counters are added. `looks` as in Rounds. Throws scene::Interrupted if
  // `progress` says so.
  void render(const scene::View&, const FilmOnDevice&, Frame&, const std::function<void(const Band&)>& fill,
              const Buffer* totals, bool looks, const std::function<bool(double)>& progress);
  // Rounds::note and Rounds::unfinished.
  void note(Download& download) const { rounds_.note(download); }
  bool unfinished(const Download& download) const { return rounds_.unfinished(download); }

 private:
  Picture(Context&, const scene::Scene&, const MediaOnDevice&, const Columns&, int lights,
          const airlight::ray_marcher::Options&, const FirstHits*, const MaterialTables&);
  void reflect(const scene::View&, const FilmOnDevice&, FrameBuffers&, const Band&);
  void add_environments(const scene::View&, const FilmOnDevice&, const Band&);
  void compose(const scene::View&, const FilmOnDevice&, const Band&, bool has_media, const Buffer* totals);

  const MediaOnDevice& media_;
  const Columns& columns_;
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
