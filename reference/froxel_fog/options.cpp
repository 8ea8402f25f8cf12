#include "reference/froxel_fog/options.h"

namespace airlight::froxel_fog {
namespace {

const scene::Choices<Preset> presets = {{"fitted", Preset::fitted}, {"hdrp", Preset::hdrp}, {"godot", Preset::godot}};
const std::vector<std::string> engines = {"hdrp", "godot"};

// Defaults of Unity HDRP (Fog.cs, VolumetricLighting.compute) and of Godot 4 (volumetric_fog_process.glsl). `frames` are those of a still
// camera: HDRP filters by default and has no history, Godot goes through 16 points of its sequence.
Options options_of(Preset preset) {
  Options o;
  o.preset = preset;
  if (preset == Preset::fitted) return o;
  o.media.self_shadow = false;
  o.far = 64;
  o.blend = Blend::ema;
  if (preset == Preset::hdrp) {
    o.near = 0.1;
    o.depth = Distribution::log;
    o.jitter = Jitter::hdrp;
    o.history_weight = 6.0 / 7;
    o.filter = Filter::gauss3;
  } else {
    o.volume_size = 64;
    o.depth = Distribution::power;
    o.frames = 16;
    o.jitter = Jitter::halton;
    o.filter = Filter::gauss7;
  }
  return o;
}

void bind(scene::SettingBinder& b, Options& o) {
  b.choice("preset", o.preset, presets,
           "defaults of all other settings: fitted to the media, or those of Unity HDRP or Godot 4");
  b.integer("tile", o.tile, 1, 4096, "side of a froxel on the film [pixels]").where("volume_size", {"0"});
  b.integer("volume_size", o.volume_size, 0, 4096,
            "froxels along the mean of the film's sides, as Godot divides it; 0: use tile");
  b.integer("slices", o.slices, 1, 4096, "froxels along the view");
  b.real("near", o.near, 0, 1e100, "view depth where the slices begin [m]; 0: the camera, or fitted where far is 0");
  b.real("far", o.far, 0, 1e100, "view depth where the slices end [m]; 0: fitted to the media");
  b.choice("depth", o.depth,
           {{"equal", Distribution::equal},
            {"log", Distribution::log},
            {"power", Distribution::power},
            {"exponential", Distribution::exponential}},
           "distribution of the slices over view depth; log: that of Unity HDRP, power 2: that of Godot");
  b.real("log_c", o.log_c, 1e-6, 1e6, "c of the distribution log [1/m]: 2 - 2 * slice distribution uniformity of HDRP")
      .where("depth", {"log"});
  b.real("exponent", o.exponent, 0.1, 10, "exponent of the distribution power").where("depth", {"power"});
  b.integer("frames", o.frames, 1, 4096, "frames of the still view that are accumulated in one picture")
      .where("jitter", {"halton", "hdrp"})
      .where("reproject", {"false"});
  b.choice("jitter", o.jitter, {{"none", Jitter::none}, {"halton", Jitter::halton}, {"hdrp", Jitter::hdrp}},
           "where frames look in a froxel; none: its centre, halton: bases 2, 3, 5, hdrp: seven depths at the centre");
  b.choice("blend", o.blend, {{"mean", Blend::mean}, {"ema", Blend::ema}},
           "all frames alike, or an exponential moving average")
      .where("jitter", {"halton", "hdrp"})
      .where("frames", {"> 1"})
      .where("reproject", {"false"});
  b.real("history_weight", o.history_weight, 0, 0.9999, "what earlier frames weigh in the moving average")
      .where("jitter", {"halton", "hdrp"})
      .where("frames", {"> 1"})
      .where("blend", {"ema"})
      .where("reproject", {"false"})
      .or_where("reproject", {"true"});
  b.flag("reproject", o.reproject,
         "the next picture of a preparation is blended into the last one, moved to its camera (moving average)");
  b.choice("filter", o.filter, {{"none", Filter::none}, {"gauss3", Filter::gauss3}, {"gauss7", Filter::gauss7}},
           "blur before integration; gauss3: 3x3 froxels of a slice (HDRP), gauss7: 7 froxels on three axes (Godot)");
  lit_media::bind(b, o.media);
}

}  // namespace

std::vector<scene::SettingSpec> option_specs() {
  std::vector<scene::SettingSpec> specs = scene::list_settings(bind);
  // Conditions speak of defaults, which another preset changes: effective_settings() asks again.
  for (scene::SettingSpec& spec : specs)
    if (!spec.read_where.empty()) spec.or_where("preset", engines);
  return specs;
}

scene::Settings effective_settings(const scene::Settings& settings) {
  const auto specs = scene::list_settings(bind, options_of(settings.choice<Preset>("preset", presets)));
  return scene::Settings(specs, settings.given(specs));
}

Options read_options(const scene::Settings& effective) {
  Options options = options_of(effective.choice<Preset>("preset", presets));
  scene::SettingBinder binder(&effective);
  bind(binder, options);
  if (options.jitter == Jitter::none || options.reproject) options.frames = 1;  // without jitter all would be the same
  return options;
}

Slices slices_of(const Options& o, Interval range) {
  return Slices(o.slices, range, o.depth, o.depth == Distribution::log ? o.log_c : o.exponent);
}

}  // namespace airlight::froxel_fog
