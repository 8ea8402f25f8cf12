#include "reference/path_tracer/options.h"

namespace airlight::path_tracer {

namespace {

void bind(scene::SettingBinder& b, Options& o) {
  using Connection = Options::Connection;
  using Paths = Options::Paths;
  b.integer("samples", o.samples, 1, 0x1p50, "samples per pixel");
  b.integer("seed", o.seed, 0, 4294967295.0, "seed of all random numbers");
  b.integer("stream", o.stream, 0, 255, "0 reference, 1 test, 2.. independent repeats");
  b.choice("pixel", o.box_pixels, {{"center", false}, {"box", true}},
           "radiance through the pixel's centre, or its mean over the pixel");
  b.integer("orders", o.orders, 1, 12, "scattering orders kept in layers of their own");
  b.integer("max_order", o.max_order, -1, 1e6, "medium scatterings at most, the rest goes to `truncated`; -1: no cap");
  b.integer("max_events", o.max_events, -1, 1e6,
            "scatterings and reflections together at most; 1: what single scattering computes, "
            "surfaces lit directly; -1: no cap");
  b.real("target_error", o.target_error, 0, 1,
         "stop a tile at this relative standard error, at n = 2^k <= samples; 0: never");
  b.integer("roulette_order", o.roulette_order, 1, 1e6, "scatterings and reflections before Russian roulette");
  b.real("roulette_cap", o.roulette_cap, 0.01, 1, "greatest survival probability of the roulette");
  b.flag("supergrid", o.supergrid, "local majorants; false: one for each whole medium");
  b.integer("supergrid_cells", o.supergrid_cells, 0, 1024, "majorant cells per axis; 0: 16, or one per 4^3 voxels")
      .where("supergrid", {"true"});
  b.real("majorant_scale", o.majorant_scale, 1e-3, 1e3, "multiplies the majorants; below 1 injects a fault");
  b.choice("transmittance", o.column_transmittance, {{"column", true}, {"ratio", false}},
           "of shadow rays: noise-free column, or ratio tracking");
  b.choice("first_collision", o.forced, {{"forced", true}, {"analog", false}},
           "forced where the medium is thin or the camera ray meets no surface, or one analog flight");
  b.choice("connection", o.connection,
           {{"auto", Connection::automatic}, {"always", Connection::always}, {"never", Connection::never}},
           "bounded connection to point lights: where the light is close to a medium, always, or never");
  b.choice("paths", o.paths,
           {{"all", Paths::all},
            {"lit_surface", Paths::lit_surface},
            {"scattered_to_surface", Paths::scattered_to_surface},
            {"scattered", Paths::scattered}},
           "all; lit_surface: a surface's light seen through the medium, which scatters it at most once, on "
           "its way to the surface; scattered_to_surface: exactly once; scattered: what a medium sends to the eye, "
           "without what is seen through it");
}

}  // namespace

std::vector<scene::SettingSpec> setting_specs() { return scene::list_settings(bind); }

Options parse_options(const scene::Settings& settings) { return scene::read_settings(bind, settings); }

}  // namespace airlight::path_tracer
