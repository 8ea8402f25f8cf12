#include "methods/wavelet_fog/options.h"

#include <fmt/format.h>

#include "methods/wavelet_fog/sun_map.h"
#include "scene/base/error.h"
#include "scene/media/fogmap.h"

namespace airlight::wavelet_fog {

std::vector<scene::SettingSpec> setting_specs() {
  using namespace scene;
  return {
      choice_setting(
          "variant", "skip", {"paper", "tele", "direct", "skip", "bound", "polar", "pre"},
          "paper: approximation and details, summed (section 4.3); tele: the same, one grid at a time; direct: the map; skip: the map, empty blocks passed at once; bound: coarse where the "
          "tolerance allows; polar: integrals from the eye, tabulated once per frame; pre: approximation and wavelets, "
          "summed (before section 4.3's deconstruction)"),
      choice_setting(
          "coarse", "wavelet", {"wavelet", "clamped", "restricted"},
          "coarse grids: analysis of Haar, CDF 2.2 or 3.3 by the map's degree; its values below 0 taken as 0; p/2"),
      integer_setting("levels", "3", 0, 20, "of the decomposition, of paper, pre, tele and bound"),
      real_setting("mu", "0.6", 0, 1, "detail m of paper, pre and tele counts up to |OP| mu^m from the eye"),
      real_setting("tolerance", "0.03", 0, 1e9, "of bound: greatest error of a ray's optical depth"),
      integer_setting("angles", "512", 8, 65536,
                      "of polar, over the directions in the view; twice as many where it looks straight up or down"),
      real_setting("radial_step", "0.5", 1e-3, 1e3, "of polar, cells between entries along a ray"),
      real_setting(
          "termination", "0", 0, 0.999,
          "transmittance below which a ray ends; not with paper and pre, whose details may be negative; 0: never"),
      integer_setting("degree", "-1", -1, 3,
                      "of the splines that the pixels are coefficients of, in place of the scene's; -1: that"),
      real_setting(
          "keep", "1", 0, 1,
          "share of the wavelet coefficients of `levels` levels, the greatest, that the map is made of; 1: all"),
      real_setting("fade", "0", 0, 1e9,
                   "m; the paper's: density falls by e over this vertical distance from the eye; 0: not at all"),
      integer_setting(
          "table", "0", 0, 64,
          "of direct, pre and paper: R of the paper's tables of path integrals over whole cells, which have "
          "4 R places on a cell's perimeter; 0: exact"),
      choice_setting("lookup", "nearest", {"nearest", "bilinear"}, "in these tables"),
      flag_setting("sun", false,
                   "single scattering of directional lights in the fog, with its shadows and those of surfaces"),
      real_setting("sun_step", "0.5", 0.01, 100, "of sun, cells between the entries of its map of columns"),
      integer_setting("sun_points", "3", 1, 10, "of sun: Gauss points in a cell, at least its degree + 1"),
      integer_setting("shadow_steps", "64", 1, 65536,
                      "of sun: shadow rays over the fog on a ray, at least, and sun_points in each cell; finds shadows "
                      "wider than that"),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.variant = settings.choice<Options::Variant>("variant");
  o.coarse = settings.choice<Coarse>("coarse");
  o.levels = int(settings.integer("levels"));
  o.mu = settings.real("mu");
  o.tolerance = settings.real("tolerance");
  o.angles = int(settings.integer("angles"));
  o.radial_step = settings.real("radial_step");
  o.termination = settings.real("termination");
  o.degree = int(settings.integer("degree"));
  o.keep = settings.real("keep");
  o.fade = settings.real("fade");
  o.table = int(settings.integer("table"));
  o.lookup = settings.choice<PathTable::Lookup>("lookup");
  o.sun = settings.flag("sun");
  o.sun_step = settings.real("sun_step");
  o.sun_points = int(settings.integer("sun_points"));
  o.shadow_steps = int(settings.integer("shadow_steps"));
  return o;
}

bool uses_levels(Options::Variant variant) {
  using V = Options::Variant;
  return is_signed(variant) || variant == V::tele || variant == V::bound;
}

bool is_signed(Options::Variant variant) {
  return variant == Options::Variant::paper || variant == Options::Variant::pre;
}

const char* family_of_degree(int degree) {
  constexpr const char* names[] = {"haar", "cdf22", "cdf33", ""};
  return names[degree];
}

namespace {

// Against a choice of settings, whatever the scene.
void add_reasons_of_settings(const Options& o, std::vector<std::string>& reasons) {
  using V = Options::Variant;
  if (is_signed(o.variant) && o.termination > 0)
    reasons.push_back(
        fmt::format("termination with variant = {}: its details may be negative, a later cell may take depth away",
                    o.variant == V::pre ? "pre" : "paper"));
  if (o.variant == V::pre && o.coarse != Coarse::wavelet)
    reasons.push_back("variant = pre reads wavelets: expected coarse = wavelet");
  if (o.table > 0 && o.variant != V::direct && !is_signed(o.variant))
    reasons.push_back("table is for variant = direct, pre or paper");
}

// Against the layer of the sun.
void add_reasons_of_sun(const scene::Scene& scene, const Options& o, std::vector<std::string>& reasons) {
  if (o.fade > 0) reasons.push_back("sun with fade, which depends on the eye: the sun has its own way through the fog");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string why = scene::unknown_light<scene::DirectionalLight, scene::EnvironmentLight>(scene.lights, i);
    if (!why.empty()) reasons.push_back("sun: " + why);
    const auto* sun = std::get_if<scene::DirectionalLight>(&scene.lights[i]);
    for (std::size_t m = 0; m < scene.media.size() && sun; ++m) {
      const auto* fog = std::get_if<scene::FogmapPointer>(&scene.media[m].field);
      if (!fog) continue;
      if (sun->to_light[1] < 0 && std::holds_alternative<scene::ExponentialFall>((*fog)->profile))
        reasons.push_back(fmt::format(
            "sun: light {} shines from below the horizon, and the profile of {} is exponential: no map holds its columns",
            i, scene::label(scene.media, m)));
      if (const double entries = SunMap::entries(**fog, sun->to_light, o.sun_step); entries > SunMap::most_entries)
        reasons.push_back(fmt::format("sun_step = {}: a map of {:.2g} entries for {}, expected at most {:.2g}",
                                      o.sun_step, entries, scene::label(scene.media, m), SunMap::most_entries));
    }
  }
}

}  // namespace

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& o) {
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const std::string why = scene::unknown_field<scene::FogmapPointer>(scene.media, i);
    if (!why.empty()) {
      reasons.push_back(why);
      continue;
    }
    const scene::Fogmap& fog = *std::get<scene::FogmapPointer>(scene.media[i].field);
    const scene::SplineMap& map = fog.map;
    if (!uses_levels(o.variant) && o.keep == 1) continue;
    if (o.levels > most_levels(map.range()))
      reasons.push_back(fmt::format("levels = {}, expected at most {} for the {} x {} coefficients of {}", o.levels,
                                    most_levels(map.range()), map.range().size[0], map.range().size[1],
                                    scene::label(scene.media, i)));
    if (o.keep < 1 && o.levels == 0) reasons.push_back("keep with levels = 0: without levels there are no wavelets");
    if ((o.degree < 0 ? map.degree() : o.degree) == 3 &&
        (o.coarse != Coarse::restricted || o.variant == Options::Variant::pre || o.keep < 1))
      reasons.push_back(
          fmt::format("{} has degree 3, for which there is no wavelet: expected coarse = restricted, keep = 1",
                      scene::label(scene.media, i)));
  }
  add_reasons_of_settings(o, reasons);
  const bool polar = o.variant == Options::Variant::polar;
  if (polar && scene.camera.kind != scene::Camera::Kind::perspective)
    reasons.push_back("variant = polar is for perspective cameras: it tabulates integrals from the eye");
  if (polar && o.fade > 0) reasons.push_back("variant = polar with fade: its table holds no exponential");
  for (std::size_t i = 0; i < scene.media.size() && polar; ++i)
    if (const auto* fog = std::get_if<scene::FogmapPointer>(&scene.media[i].field);
        fog && std::holds_alternative<scene::ExponentialFall>((*fog)->profile))
      reasons.push_back(fmt::format("variant = polar: the profile of {} is exponential, expected none or layers",
                                    scene::label(scene.media, i)));
  if (o.fade > 0)
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      if (const auto* fog = std::get_if<scene::FogmapPointer>(&scene.media[i].field);
          fog && !std::holds_alternative<scene::SameAtAllHeights>((*fog)->profile))
        reasons.push_back(fmt::format("fade with a profile of {}: one or the other", scene::label(scene.media, i)));
  if (o.sun) add_reasons_of_sun(scene, o, reasons);
  return reasons;
}

}  // namespace airlight::wavelet_fog
