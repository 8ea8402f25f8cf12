// The media and lights of reference/lit_media on the device: what lit_media.glsl reads. Froxels and the half-resolution march include
// it in their programs.
//
//   LitMedia lit(context, plan, storage, first_hits, timer, progress);
//   definitions = lit.definitions();                    // and LOCAL_SIZE_X, LOCAL_SIZE_Y
//   Program& p = ray_marcher::program(context, "folder/pass.comp", definitions);
//   lit.bind(p);                                        // storage blocks 0 to 4, 9 and 14, uniform block 0, texture units
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "gpu/raster/first_hits.h"
#include "gpu/ray_marcher/columns.h"
#include "reference/lit_media/lit_media.h"

namespace airlight::gpu::lit_media {

class LitMedia {
 public:
  // Uploads, and makes the maps: the timer's stages "upload" (ended here where there are maps) and "light_maps". Keeps the plan and the
  // first hits by reference; these may be null where the scene has no surfaces. Throws Unavailable where the device has no room,
  // Interrupted if `progress` says so.
  LitMedia(Context&, const airlight::lit_media::Plan&, ray_marcher::GridStorage, const FirstHits*, StageTimer&,
           const std::function<bool(double)>& progress);

  // Do programs and buffers for the plan serve `next` too?
  bool is_like(const airlight::lit_media::Plan& next) const;
  // The plan has become another, which this is_like; `same_media`: with the same media as before. Uploads what has changed, and draws the maps
  // that are not kept.
  void become(bool same_media, StageTimer&, const std::function<bool(double)>& progress);
  int maps_made() const { return maps_made_; }  // for the plan as it is now; others are of frames before

  const airlight::lit_media::Plan& plan() const { return plan_; }
  const ray_marcher::MediaOnDevice& media() const { return media_; }
  const ray_marcher::Columns& columns() const { return columns_; }

  std::map<std::string, std::string> definitions() const;
  void bind(LinkedProgram&) const;

 private:
  Context& context_;
  const airlight::lit_media::Plan& plan_;
  const FirstHits* first_hits_;
  std::vector<scene::Light> lights_;  // in the order of the device
  ray_marcher::MediaOnDevice media_;
  ray_marcher::Columns columns_;
  std::unique_ptr<Buffer> solids_;
  int maps_made_ = 0;
};

// Reasons of the device against a scene with these media and lights, one line each, beside those of the CPU.
std::vector<std::string> unsupported(const scene::Scene&);

}  // namespace airlight::gpu::lit_media
