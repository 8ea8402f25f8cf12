#include "reference/path_tracer/options.h"

namespace airlight::path_tracer {

std::vector<scene::SettingSpec> setting_specs() {
  using Type = scene::SettingSpec::Type;
  return {
      {"samples", Type::integer, "256", "samples per pixel", 1, 0x1p50, {}},
      {"seed", Type::integer, "1", "seed of all random numbers", 0, 4294967295.0, {}},
      {"stream", Type::integer, "0", "0 reference, 1 test, 2.. independent repeats", 0, 255, {}},
      {"pixel",
       Type::choice,
       "center",
       "radiance through the pixel's centre, or its mean over the pixel",
       0,
       0,
       {"center", "box"}},
      {"orders", Type::integer, "4", "scattering orders kept in layers of their own", 1, 12, {}},
      {"max_order",
       Type::integer,
       "-1",
       "medium scatterings at most, the rest goes to `truncated`; -1: no cap",
       -1,
       1e6,
       {}},
      {"target_error",
       Type::real,
       "0",
       "stop a tile at this relative standard error, at n = 2^k <= samples; 0: never",
       0,
       1,
       {}},
      {"roulette_order", Type::integer, "5", "scatterings and reflections before Russian roulette", 1, 1e6, {}},
      {"roulette_cap", Type::real, "1", "greatest survival probability of the roulette", 0.01, 1, {}},
      {"supergrid", Type::flag, "true", "local majorants; false: one for each whole medium", 0, 0, {}},
      {"supergrid_cells", Type::integer, "0", "majorant cells per axis; 0: 16, or one per 4^3 voxels", 0, 1024, {}},
      {"majorant_scale", Type::real, "1", "multiplies the majorants; below 1 injects a fault", 1e-3, 1e3, {}},
      {"transmittance",
       Type::choice,
       "column",
       "of shadow rays: noise-free column, or ratio tracking",
       0,
       0,
       {"column", "ratio"}},
      {"first_collision",
       Type::choice,
       "forced",
       "forced where the medium is thin or the camera ray meets no surface, or one analog flight",
       0,
       0,
       {"forced", "analog"}},
      {"connection",
       Type::choice,
       "auto",
       "bounded connection to point lights: where the light is close to a medium, always, or never",
       0,
       0,
       {"auto", "always", "never"}},
      {"paths",
       Type::choice,
       "all",
       "all; lit_surface: a surface's light seen through the medium, which scatters it at most once, on its way to the "
       "surface; scattered_to_surface: exactly once",
       0,
       0,
       {"all", "lit_surface", "scattered_to_surface"}},
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
  o.target_error = settings.real("target_error");
  o.roulette_order = int(settings.integer("roulette_order"));
  o.roulette_cap = settings.real("roulette_cap");
  o.supergrid = settings.flag("supergrid");
  o.supergrid_cells = int(settings.integer("supergrid_cells"));
  o.majorant_scale = settings.real("majorant_scale");
  o.column_transmittance = settings.text("transmittance") == "column";
  o.forced = settings.text("first_collision") == "forced";
  const std::string& connection = settings.text("connection");
  o.connection = connection == "always"  ? Options::Connection::always
                 : connection == "never" ? Options::Connection::never
                                         : Options::Connection::automatic;
  const std::string& paths = settings.text("paths");
  o.paths = paths == "lit_surface"            ? Options::Paths::lit_surface
            : paths == "scattered_to_surface" ? Options::Paths::scattered_to_surface
                                              : Options::Paths::all;
  return o;
}

}  // namespace airlight::path_tracer
