// Frames of a still view that are accumulated in one volume: where each looks, what it weighs, and what it sees.
#pragma once
#include "reference/froxel_fog/history.h"
#include "scene/scene.h"

namespace airlight::froxel_fog {

// Where a frame (0, 1, ...) looks in its froxels: film x, film y and u, each from 0 to 1 of a froxel. The sequences: Godot 4
// (volumetric_fog_process.glsl, Halton), Unity HDRP (zSeq of its volumetric lighting).
Vec3 jitter(Jitter, int frame);

// Weight of the history when a frame (0, 1, ...) of one picture is added to it; the frame has the remaining weight.
float history_weight(const Options&, int frame);

// Work done.
struct Counters {
  lit_media::Counters media;
  long long rays = 0;         // through froxels and pixels, to what ends them
  long long reprojected = 0;  // froxels with a history of another picture
  void operator+=(const Counters&);
};

// History that a frame is blended into, with the weight `weight`: the content of the volume, or the content of the last
// picture where the froxel's middle was in it. A froxel outside the last picture has no history.
struct Before {
  float weight = 0;
  const History* picture = nullptr;
};

// Adds one frame to the volume, before integration. A froxel behind what ends the ray through it is empty.
Counters inject(const lit_media::LitMedia&, const scene::Scene&, const scene::View&, const Vec3& jitter, const Before&,
                Volume&, const scene::Execution&);

}  // namespace airlight::froxel_fog
