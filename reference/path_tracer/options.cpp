#include "reference/path_tracer/options.h"

namespace airlight::path_tracer {

std::vector<scene::SettingSpec> setting_specs() {
  return {
      scene::integer_setting("samples", "256", 1, 0x1p50, "samples per pixel"),
      scene::integer_setting("seed", "1", 0, 4294967295.0, "seed of all random numbers"),
      scene::integer_setting("stream", "0", 0, 255, "0 reference, 1 test, 2.. independent repeats"),
      scene::choice_setting("pixel", "center", {"center", "box"},
                            "radiance through the pixel's centre, or its mean over the pixel"),
      scene::integer_setting("orders", "4", 1, 12, "scattering orders kept in layers of their own"),
      scene::integer_setting("max_order", "-1", -1, 1e6,
                             "medium scatterings at most, the rest goes to `truncated`; -1: no cap"),
      scene::integer_setting("max_events", "-1", -1, 1e6,
                             "scatterings and reflections together at most; 1: what single scattering computes, "
                             "surfaces lit directly; -1: no cap"),
      scene::real_setting("target_error", "0", 0, 1,
                          "stop a tile at this relative standard error, at n = 2^k <= samples; 0: never"),
      scene::integer_setting("roulette_order", "5", 1, 1e6, "scatterings and reflections before Russian roulette"),
      scene::real_setting("roulette_cap", "1", 0.01, 1, "greatest survival probability of the roulette"),
      scene::flag_setting("supergrid", true, "local majorants; false: one for each whole medium"),
      scene::integer_setting("supergrid_cells", "0", 0, 1024, "majorant cells per axis; 0: 16, or one per 4^3 voxels")
          .where("supergrid", {"true"}),
      scene::real_setting("majorant_scale", "1", 1e-3, 1e3, "multiplies the majorants; below 1 injects a fault"),
      scene::choice_setting("transmittance", "column", {"column", "ratio"},
                            "of shadow rays: noise-free column, or ratio tracking"),
      scene::choice_setting("first_collision", "forced", {"forced", "analog"},
                            "forced where the medium is thin or the camera ray meets no surface, or one analog flight"),
      scene::choice_setting(
          "connection", "auto", {"auto", "always", "never"},
          "bounded connection to point lights: where the light is close to a medium, always, or never"),
      scene::choice_setting(
          "paths", "all", {"all", "lit_surface", "scattered_to_surface", "scattered"},
          "all; lit_surface: a surface's light seen through the medium, which scatters it at most once, on "
          "its way to the surface; scattered_to_surface: exactly once; scattered: what a medium sends to the eye, "
          "without what is seen through it"),
  };
}

Options parse_options(const scene::Settings& settings) {
  Options o;
  o.samples = std::uint64_t(settings.integer("samples"));
  o.seed = std::uint32_t(settings.integer("seed"));
  o.stream = std::uint32_t(settings.integer("stream"));
  o.box_pixels = settings.text("pixel") == "box";
  o.orders = int(settings.integer("orders"));
  o.max_order = int(settings.integer("max_order"));
  o.max_events = int(settings.integer("max_events"));
  o.target_error = settings.real("target_error");
  o.roulette_order = int(settings.integer("roulette_order"));
  o.roulette_cap = settings.real("roulette_cap");
  o.supergrid = settings.flag("supergrid");
  o.supergrid_cells = int(settings.integer("supergrid_cells"));
  o.majorant_scale = settings.real("majorant_scale");
  o.column_transmittance = settings.text("transmittance") == "column";
  o.forced = settings.text("first_collision") == "forced";
  o.connection = settings.choice<Options::Connection>("connection");
  o.paths = settings.choice<Options::Paths>("paths");
  return o;
}

}  // namespace airlight::path_tracer
