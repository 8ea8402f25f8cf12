// A plan of the ray marcher on the device: what its shaders read, and their dispatches.
#pragma once
#include "gpu/ray_marcher/picture.h"
#include "reference/ray_marcher/plan.h"
#include "scene/renderer.h"

namespace airlight::gpu::ray_marcher {

class PlanOnDevice {
 public:
  // Uploads, and makes the lights' maps; keeps the plan and the surfaces by reference (null: there are none, nor balls of
  // lights). Throws Unavailable where the device has no room, Interrupted if `progress` says so.
  PlanOnDevice(Context&, const airlight::ray_marcher::Plan&, GridStorage, const FirstHits*, StageTimer&,
               const std::function<bool(double)>& progress);

  // Do programs and buffers for the plan serve `next` too?
  bool is_like(const airlight::ray_marcher::Plan& next) const;
  // The plan has become another, which this is_like; `same_media`: with the same media as before. Uploads what has changed, and draws the maps
  // that are not kept: how many. Throws Unavailable where a software renderer would end loops.
  int become(bool same_media, StageTimer&, const std::function<bool(double)>& progress);
  // Environments of the next frame (Picture::become).
  bool become_lit(const scene::Scene& scene) { return picture_.become(scene); }

  const GridsOnDevice& grids() const { return media_.grids(); }
  bool has_maps() const { return columns_.maps() != nullptr; }

  // Media, surfaces, environment and composition, the stages of frame.timer, in bands of the image whose state fits into
  // a buffer. `totals` as in Picture: of steps, shadow rays or look-ups, shadow steps, occlusion rays. `looks` as in Rounds. Throws scene::Interrupted if `progress` says so.
  void render(const scene::View&, const FilmOnDevice&, Frame&, const Buffer* totals, bool looks,
              const std::function<bool(double)>& progress);
  // Rounds::note and Rounds::unfinished of all that takes several.
  void note(Download&) const;
  bool unfinished(const Download&) const;

 private:
  void check_iterations() const;
  void march(const scene::View&, const FilmOnDevice&, FrameBuffers&, const Band&);

  Context& context_;
  const airlight::ray_marcher::Plan& plan_;
  const FirstHits* first_hits_;
  std::vector<scene::Light> lights_;  // in the order of the device
  int balls_;                         // point and spot lights
  bool has_occluders_;
  MediaOnDevice media_;
  Columns columns_;
  std::unique_ptr<Buffer> solids_;
  Program* march_ = nullptr;  // null: left out
  Rounds march_rounds_;
  Picture picture_;
};

}  // namespace airlight::gpu::ray_marcher
