// Settings of the half-resolution march.
#pragma once
#include <vector>

#include "reference/lit_media/lit_media.h"
#include "scene/base/settings.h"

namespace airlight::half_resolution_march {

// Where the steps of a marched pixel lie within equal parts of its ray: at their middles, or by an offset of its own.
enum class Jitter { none, bayer, noise };

struct Options {
  lit_media::Options media;
  int divide = 2;                 // film pixels per marched pixel and axis
  int steps = 16;                 // of a ray
  bool from_camera = false;       // steps begin at the camera; else where media begin
  Jitter jitter = Jitter::noise;  // jitter.h
  bool analytic = true;           // a step's extinction is integrated; else source * transmittance * length
  int frames = 1;                 // averaged, each with offsets of its own
  bool blur = false;              // bilateral, of the marched pixels (filter.h)
  bool nearest_depth = true;      // where depths differ, upsampling takes one neighbour; else always bilinear
  bool min_max = true;     // a marched pixel is the nearest or the farthest of its block; else the block's centre
  bool reproject = false;  // the next picture is blended into the last one (history.h)
  double history_weight = 0.9;
  bool airlight_depth = true;  // a ray is looked for where its airlight comes from; else where it ends
  bool clamp = false;          // the last picture, to what the 3 x 3 marched pixels around have
  double edge = 0.03125;       // depth that counts as an edge, as a share of the longest way through media
};

constexpr double horizon = 16;  // optical depth at which an endless ray is cut

std::vector<scene::SettingSpec> option_specs();
Options read_options(const scene::Settings&);

}  // namespace airlight::half_resolution_march
