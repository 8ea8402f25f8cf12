#include "reference/path_tracer/identity.h"

#include <fmt/format.h>

#include "airlight_build_info.h"
#include "scene/load/content_hash.h"

namespace airlight::path_tracer {

std::string build_id() {
#ifdef NDEBUG
  const char* const kind = "optimised";
#else
  const char* const kind = "debug";
#endif
  return fmt::format("{} gcc {} {}", AIRLIGHT_REFERENCE_ID, __VERSION__, kind);
}

Identity identity_of(const scene::Scene& scene, const scene::View& view, const Options& o) {
  scene::load::ContentHash hash;
  hash.tag("view");
  hash.add(int(view.camera.kind));
  hash.add(view.camera.position);
  hash.add(view.camera.forward);
  hash.add(view.camera.right);
  hash.add(view.camera.up);
  hash.add(view.camera.vertical_fov);
  hash.add(view.camera.height);
  hash.add(view.width);
  hash.add(view.height);
  const char* const connections[] = {"auto", "always", "never"};
  const char* const paths[] = {"all", "lit_surface", "scattered_to_surface", "scattered"};
  return {scene.hash,
          hash.digits(),
          fmt::format("pixel={} orders={} max_order={} max_events={} roulette_order={} roulette_cap={} supergrid={} "
                      "supergrid_cells={} majorant_scale={} transmittance={} first_collision={} connection={} paths={}",
                      o.box_pixels ? "box" : "center", o.orders, o.max_order, o.max_events, o.roulette_order,
                      o.roulette_cap, o.supergrid, o.supergrid_cells, o.majorant_scale,
                      o.column_transmittance ? "column" : "ratio", o.forced ? "forced" : "analog",
                      connections[int(o.connection)], paths[int(o.paths)]),
          o.seed,
          o.stream,
          build_id()};
}

std::string difference(const Identity& a, const Identity& b) {
  const auto say = [](const char* what, const auto& x, const auto& y) {
    return fmt::format("{} differs: {} and {}", what, x, y);
  };
  if (a.scene != b.scene) return say("scene", a.scene, b.scene);
  if (a.view != b.view) return say("view (camera or film size)", a.view, b.view);
  if (a.settings != b.settings) return say("settings", a.settings, b.settings);
  if (a.seed != b.seed) return say("seed", a.seed, b.seed);
  if (a.stream != b.stream) return say("stream", a.stream, b.stream);
  if (a.build != b.build) return say("build", a.build, b.build);
  return {};
}

}  // namespace airlight::path_tracer
