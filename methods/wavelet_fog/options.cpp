#include "methods/wavelet_fog/options.h"

#include <fmt/format.h>

#include "methods/wavelet_fog/sun_map.h"
#include "scene/base/error.h"
#include "scene/media/fogmap.h"

namespace airlight::wavelet_fog {

namespace {

void bind(scene::SettingBinder& b, Options& o) {
  using V = Options::Variant;
  b.choice(
      "variant", o.variant,
      {{"paper", V::paper},
       {"tele", V::tele},
       {"direct", V::direct},
       {"skip", V::skip},
       {"bound", V::bound},
       {"polar", V::polar},
       {"pre", V::pre}},
      "paper: approximation and details, summed (section 4.3); tele: the same, one grid at a time; direct: the map; skip: the map, empty blocks passed at once; bound: coarse where the "
      "tolerance allows; polar: integrals from the eye, tabulated once per frame; pre: approximation and wavelets, "
      "summed (before section 4.3's deconstruction)");
  const std::vector<std::string> with_levels = {"paper", "pre", "tele", "bound"};
  b.choice("coarse", o.coarse,
           {{"wavelet", Coarse::wavelet}, {"clamped", Coarse::clamped}, {"restricted", Coarse::restricted}},
           "coarse grids: analysis of Haar, CDF 2.2 or 3.3 by the map's degree; its values below 0 taken as 0; p/2")
      .where("variant", with_levels);
  b.integer("levels", o.levels, 0, 20, "of the decomposition, of paper, pre, tele and bound")
      .where("variant", with_levels)
      .or_where("keep", {"< 1"});
  b.real("mu", o.mu, 0, 1, "detail m of paper, pre and tele counts up to |OP| mu^m from the eye")
      .where("variant", {"paper", "pre", "tele"});
  b.real("tolerance", o.tolerance, 0, 1e9, "of bound: greatest error of a ray's optical depth")
      .where("variant", {"bound"});
  b.integer("angles", o.angles, 8, 65536,
            "of polar, over the directions in the view; twice as many where it looks straight up or down")
      .where("variant", {"polar"});
  b.real("radial_step", o.radial_step, 1e-3, 1e3, "of polar, cells between entries along a ray")
      .where("variant", {"polar"});
  b.real("termination", o.termination, 0, 0.999,
         "transmittance below which a ray ends; not with paper and pre, whose details may be negative; 0: never")
      .where("variant", {"skip", "bound", "polar"})
      .or_where("variant", {"tele", "direct"})
      .where("sun", {"true"});
  b.integer("degree", o.degree, -1, 3,
            "of the splines that the pixels are coefficients of, in place of the scene's; -1: that");
  b.real("keep", o.keep, 0, 1,
         "share of the wavelet coefficients of `levels` levels, the greatest, that the map is made of; 1: all");
  b.real("fade", o.fade, 0, 1e9,
         "m; the paper's: density falls by e over this vertical distance from the eye; 0: not at all");
  const std::vector<std::string> with_tables = {"direct", "pre", "paper"};
  b.integer("table", o.table, 0, 64,
            "of direct, pre and paper: R of the paper's tables of path integrals over whole cells, which have "
            "4 R places on a cell's perimeter; 0: exact")
      .where("variant", with_tables);
  b.choice("lookup", o.lookup, {{"nearest", PathTable::Lookup::nearest}, {"bilinear", PathTable::Lookup::bilinear}},
           "in these tables")
      .where("table", {"> 0"})
      .where("variant", with_tables);
  b.flag("sun", o.sun, "single scattering of directional lights in the fog, with its shadows and those of surfaces");
  b.real("sun_step", o.sun_step, 0.01, 100, "of sun, cells between the entries of its map of columns")
      .where("sun", {"true"});
  b.integer("sun_points", o.sun_points, 1, 10, "of sun: Gauss points in a cell, at least its degree + 1")
      .where("sun", {"true"});
  b.integer("shadow_steps", o.shadow_steps, 1, 65536,
            "of sun: shadow rays over the fog on a ray, at least, and sun_points in each cell; finds shadows "
            "wider than that")
      .where("sun", {"true"});
}

}  // namespace

std::vector<scene::SettingSpec> setting_specs() { return scene::list_settings(bind); }

Options read_options(const scene::Settings& settings) { return scene::read_settings(bind, settings); }

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
  if (o.variant == Options::Variant::pre && o.coarse != Coarse::wavelet)
    reasons.push_back("variant = pre reads wavelets: expected coarse = wavelet");
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
