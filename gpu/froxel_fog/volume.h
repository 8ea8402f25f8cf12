// The froxels of a picture on the device, and what is done with all of them: reference/froxel_fog/volume.h, fit.h and frames.h.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "gpu/frame.h"
#include "gpu/lit_media/lit_media.h"
#include "gpu/raster/backdrops.h"
#include "gpu/ray_marcher/picture.h"
#include "reference/froxel_fog/volume.h"

namespace airlight::gpu::froxel_fog {

using airlight::froxel_fog::Options;

// A picture's light and media before filter and integration, which the next picture may begin with.
struct Froxels {
  airlight::froxel_fog::Cells cells;
  scene::View view;
  std::unique_ptr<Buffer> light, media;  // a vec4 each
  std::unique_ptr<Buffer> slices;        // grid.glsl
};

// Ends of camera rays; null: nothing ends them.
struct Ends {
  const FirstHits* surfaces;
  const Backdrops* backdrops;
};

class Volume {
 public:
  // Keeps all by reference. `frames`: jitter and weight of the history of each frame of a picture. `history`: of another picture, or null.
  Volume(Context&, const Options&, const lit_media::LitMedia&, const Ends&,
         const std::vector<std::array<float, 4>>& frames, const Froxels* history);

  // Fills `froxels`, allocating what they lack: the stages "fit", "inject", "filter" and "integrate" of the frame. `distances`: of the
  // pixels, null where nothing ends rays. Throws Unavailable where the device has no room, Interrupted if `progress` says so.
  void make(const scene::View&, const Buffer* distances, Froxels&, Frame&, bool counts, bool looks,
            const std::function<bool(double)>& progress);
  // The stage "picture": what each pixel of a band sees in the volume made last.
  void look_up(const scene::View&, const Buffer* distances, const Froxels&, const ray_marcher::Band&, Frame&);

  // Rounds::note and Rounds::unfinished, and values to come down: "froxel totals", low and high words of points, look-ups, occlusion
  // rays and reprojected froxels; "range", the slices' range and 1, or 0 where it is empty.
  void note(Frame&, const Froxels&) const;
  bool unfinished(const Download& download) const { return rounds_.unfinished(download); }

 private:
  void fit(const scene::View&, const Buffer* distances, Frame&);
  void lay_slices(Froxels&, Frame&, int first_frame, int count);
  void find_ends(const scene::View&, const Froxels&, const Buffer& ends, int first_frame, int count);
  void inject(const scene::View&, Froxels&, Frame&, int first_frame, int count, int batch, bool counts);
  void set_grid(LinkedProgram&, const Froxels&) const;
  void set_slices(LinkedProgram&) const;

  Context& context_;
  const Options& options_;
  const lit_media::LitMedia& lit_;
  Ends ends_;
  std::vector<std::array<float, 4>> frames_;
  const Froxels* history_;
  Buffer frame_data_;
  Program &slices_, &inject_, &integrate_, &picture_;
  Program *fit_ = nullptr, *filter_ = nullptr;  // null: left out
  ray_marcher::Rounds rounds_;
  std::pair<const Buffer*, const Buffer*> integrated_;  // airlight and transmittance, of the frame's buffers
};

}  // namespace airlight::gpu::froxel_fog
