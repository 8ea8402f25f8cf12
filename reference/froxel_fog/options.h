// Settings of froxel fog.
#pragma once
#include "reference/froxel_fog/slices.h"
#include "reference/lit_media/lit_media.h"
#include "scene/base/settings.h"

namespace airlight::froxel_fog {

enum class Preset { fitted, hdrp, godot };
// Where in its froxel a frame looks: the centre; points of a Halton sequence; the centre of the film's cell at seven depths.
enum class Jitter { none, halton, hdrp };
// How a frame joins those before it: as one of equals, or with a fixed weight (an exponential moving average).
enum class Blend { mean, ema };
enum class Filter { none, gauss3, gauss7 };

// Defaults are those of the preset `fitted`.
struct Options {
  Preset preset = Preset::fitted;
  int tile = 8;         // side of a froxel on the film [pixels]
  int volume_size = 0;  // > 0: so many froxels along the mean of the film's sides, instead of `tile`
  int slices = 64;
  // View depth where the first slice begins and the last one ends [m]. far = 0: fitted to the media, and near = 0 with it.
  double near = 0;
  double far = 0;
  Distribution depth = Distribution::equal;
  double log_c = 0.5;  // [1/m]
  double exponent = 2;
  int frames = 1;
  Jitter jitter = Jitter::none;
  Blend blend = Blend::mean;
  double history_weight = 0.9;
  bool reproject =
      false;  // each picture is one frame, blended into the one before it, which another camera may have seen
  Filter filter = Filter::none;
  lit_media::Options media;
};

// The slices that cover a range [m], which is not empty.
Slices slices_of(const Options&, Interval range);

// All settings with the defaults of `fitted`. A setting that is read only beside others is also accepted beside the
// presets of engines, whose defaults may enable it.
std::vector<scene::SettingSpec> option_specs();

// The settings with the defaults of their preset. Throws Error for a given one that is not read beside the others.
scene::Settings effective_settings(const scene::Settings&);
Options read_options(const scene::Settings& effective);

}  // namespace airlight::froxel_fog
