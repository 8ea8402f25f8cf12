#include "reference/half_resolution_march/options.h"

namespace airlight::half_resolution_march {
namespace {

void bind(scene::SettingBinder& b, Options& o) {
  b.integer("divide", o.divide, 1, 64, "film pixels per marched pixel and axis; 1: full resolution");
  b.integer("steps", o.steps, 1, 1 << 16, "steps of each marched ray, of equal length");
  b.choice(
      "interval", o.from_camera, {{"media", false}, {"camera", true}},
      "where steps begin: media: where media begin on the ray; camera: at the camera; they end with the media or at "
      "the first hit");
  b.choice("jitter", o.jitter, {{"none", Jitter::none}, {"bayer", Jitter::bayer}, {"noise", Jitter::noise}},
           "offset of a pixel's steps within their length: none: the middle; bayer: ordered, 8 x 8 pixels; noise: "
           "interleaved gradient noise");
  b.choice("integration", o.analytic, {{"analytic", true}, {"riemann", false}},
           "light of a step: analytic: its extinction integrated; riemann: source times transmittance times length");
  b.integer("frames", o.frames, 1, 4096, "frames of a still view, each with other offsets, averaged in one render")
      .where("jitter", {"bayer", "noise"})
      .where("reproject", {"false"});
  b.flag(
      "reproject", o.reproject,
      "every picture is one frame; the next picture of a preparation is blended into the last one, moved to its camera");
  b.real("history_weight", o.history_weight, 0, 0.9999, "what the last picture weighs in the next one")
      .where("reproject", {"true"});
  b.choice("history_depth", o.airlight_depth, {{"airlight", true}, {"end", false}},
           "by which point a ray is found in the last picture: airlight: the mean depth that its airlight comes from; "
           "end: what ends it, or where media end")
      .where("reproject", {"true"});
  b.choice(
       "clamp", o.clamp, {{"none", false}, {"neighbourhood", true}},
       "neighbourhood: the last picture is limited to the range of the 3 x 3 new marched pixels: trails vanish, and "
       "some of the history is lost")
      .where("reproject", {"true"});
  b.choice("blur", o.blur, {{"bilateral", true}, {"none", false}},
           "filter of the marched pixels: bilateral: 11 x 11, separable, that stops at edges of depth");
  b.choice("depth", o.min_max, {{"min_max", true}, {"centre", false}},
           "which ray of a block is marched: min_max: the pixel of least or greatest depth, in turn as on a "
           "checkerboard; centre: through the middle")
      .where("divide", {"> 1"});
  b.choice("upsample", o.nearest_depth, {{"nearest_depth", true}, {"bilinear", false}},
           "to film pixels: nearest_depth: bilinear, but at edges of depth the neighbour of nearest depth; bilinear: "
           "always")
      .where("divide", {"> 1"});
  b.real("edge", o.edge, 1e-9, 1e9,
         "difference of depth that counts as an edge, as a share of the longest way through media in the picture: 2 of "
         "64 m in engines")
      .where("blur", {"bilateral"})
      .or_where("reproject", {"true"})
      .or_where("divide", {"> 1"})
      .where("upsample", {"nearest_depth"});
  lit_media::bind(b, o.media);
}

}  // namespace

std::vector<scene::SettingSpec> option_specs() { return scene::list_settings(bind); }

Options read_options(const scene::Settings& settings) {
  Options options = scene::read_settings(bind, settings);
  if (options.reproject) options.frames = 1;
  return options;
}

}  // namespace airlight::half_resolution_march
