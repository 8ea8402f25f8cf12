#include "methods/wavelet_fog/options.h"

#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::wavelet_fog {

std::vector<scene::SettingSpec> setting_specs() {
  using namespace scene;
  return {
      choice_setting(
          "variant", "skip", {"paper", "tele", "dist", "direct", "skip", "bound", "polar", "bands"},
          "paper: approximation and details, summed (section 4.3); tele: the same, one grid at a time; dist: levels by "
          "absolute distance; direct: the map; skip: the map, empty blocks passed at once; bound: coarse where the "
          "tolerance allows; polar: integrals from the eye, tabulated once per frame; bands: as paper, before deconstruction (Table 3)"),
      choice_setting(
          "coarse", "wavelet", {"wavelet", "clamped", "restricted"},
          "coarse grids: analysis of Haar, CDF 2.2 or 3.3 by the map's degree; its values below 0 taken as 0; p/2"),
      integer_setting("levels", "3", 0, 20, "of the decomposition, of paper, tele, dist and bound"),
      real_setting("mu", "0.6", 0, 1, "detail m of paper and tele counts up to |OP| mu^m from the eye"),
      real_setting("near", "16", 0, 1e9,
                   "cells up to which dist reads the finest level; each coarser one reaches twice as far"),
      real_setting("tolerance", "0.03", 0, 1e9, "of bound: greatest error of a ray's optical depth"),
      integer_setting("angles", "512", 8, 65536,
                      "of polar, over the directions in the view; twice as many where it looks straight up or down"),
      real_setting("radial_step", "0.5", 1e-3, 1e3, "of polar, cells between entries along a ray"),
      real_setting("termination", "0", 0, 0.999,
                   "transmittance below which a ray ends; not with paper, whose details may be negative; 0: never"),
      integer_setting("degree", "-1", -1, 3,
                      "of the splines that the pixels are coefficients of, in place of the scene's; -1: that"),
      real_setting(
          "keep", "1", 0, 1,
          "share of the wavelet coefficients of `levels` levels, the greatest, that the map is made of; 1: all"),
      real_setting("fade", "0", 0, 1e9,
                   "m; the paper's: density falls by e over this vertical distance from the eye; 0: not at all"),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.variant = settings.choice<Options::Variant>("variant");
  o.coarse = settings.choice<Coarse>("coarse");
  o.levels = int(settings.integer("levels"));
  o.mu = settings.real("mu");
  o.near = settings.real("near");
  o.tolerance = settings.real("tolerance");
  o.angles = int(settings.integer("angles"));
  o.radial_step = settings.real("radial_step");
  o.termination = settings.real("termination");
  o.degree = int(settings.integer("degree"));
  o.keep = settings.real("keep");
  o.fade = settings.real("fade");
  return o;
}

bool uses_levels(Options::Variant variant) {
  using V = Options::Variant;
  return variant == V::paper || variant == V::tele || variant == V::dist || variant == V::bound || variant == V::bands;
}

std::vector<std::string> reasons_against(const scene::Scene& scene, const Options& o) {
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const std::string why = scene::unknown_field<scene::FogmapPointer>(scene.media, i);
    if (!why.empty()) {
      reasons.push_back(why);
      continue;
    }
    const scene::SplineMap& map = std::get<scene::FogmapPointer>(scene.media[i].field)->map;
    if (!uses_levels(o.variant) && o.keep == 1) continue;
    if (o.levels > most_levels(map.range()))
      reasons.push_back(fmt::format("levels = {}, expected at most {} for the {} x {} coefficients of {}", o.levels,
                                    most_levels(map.range()), map.range().size[0], map.range().size[1],
                                    scene::label(scene.media, i)));
    if (o.keep < 1 && o.levels == 0) reasons.push_back("keep with levels = 0: without levels there are no wavelets");
    if ((o.degree < 0 ? map.degree() : o.degree) == 3 && (o.coarse != Coarse::restricted || o.keep < 1))
      reasons.push_back(
          fmt::format("{} has degree 3, for which there is no wavelet: expected coarse = restricted, keep = 1",
                      scene::label(scene.media, i)));
  }
  const bool bands = o.variant == Options::Variant::bands;
  if ((o.variant == Options::Variant::paper || bands) && o.termination > 0)
    reasons.push_back(
        fmt::format("termination with variant = {}: its details may be negative, a later cell may take depth away",
                    bands ? "bands" : "paper"));
  if (bands && o.coarse != Coarse::wavelet)
    reasons.push_back("variant = bands is of wavelets: expected coarse = wavelet");
  const bool polar = o.variant == Options::Variant::polar;
  if (polar && scene.camera.kind != scene::Camera::Kind::perspective)
    reasons.push_back("variant = polar is for perspective cameras: it tabulates integrals from the eye");
  if ((polar || bands) && o.fade > 0)
    reasons.push_back(polar ? "variant = polar with fade: its table holds no exponential"
                            : "variant = bands with fade: its cells hold no exponential");
  for (std::size_t i = 0; i < scene.media.size() && (polar || bands); ++i)
    if (const auto* fog = std::get_if<scene::FogmapPointer>(&scene.media[i].field);
        fog && std::holds_alternative<scene::ExponentialFall>((*fog)->profile))
      reasons.push_back(fmt::format("variant = {}: the profile of {} is exponential, expected none or layers",
                                    polar ? "polar" : "bands", scene::label(scene.media, i)));
  if (o.fade > 0)
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      if (const auto* fog = std::get_if<scene::FogmapPointer>(&scene.media[i].field);
          fog && !std::holds_alternative<scene::SameAtAllHeights>((*fog)->profile))
        reasons.push_back(fmt::format("fade with a profile of {}: one or the other", scene::label(scene.media, i)));
  return reasons;
}

}  // namespace airlight::wavelet_fog
