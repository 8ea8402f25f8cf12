#include "experiments/wavelet_fog/column_probe.h"

#include "scene/base/error.h"
#include "scene/convert/fogmap_columns.h"
#include "scene/scene.h"

namespace airlight::experiments {

std::string ColumnFogmaps::about() const { return "errors of a fogmap made from a medium's columns"; }

std::vector<scene::SettingSpec> ColumnFogmaps::settings() const {
  return {scene::integer_setting("pixels", "64", 1, 8192, "of the map, along its longer side"),
          scene::integer_setting("samples", "2", 1, 64, "squared: upright rays a pixel"),
          scene::integer_setting("degree", "1", 0, 3, "of the map's splines")};
}

std::vector<std::string> ColumnFogmaps::figures() const { return {"column_error", "density_error", "column_ratio"}; }

Findings ColumnFogmaps::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution&) const {
  if (input.file.empty()) throw Error("column_fogmap needs a [[scene]]");
  const scene::Scene scene = scene::load_scene(input.file.string(), input.overrides);
  if (scene.media.empty()) throw Error(scene.name + ": column_fogmap needs a medium");
  const scene::DensityField& field = scene.media[0].field;
  const scene::ColumnFogmap fog =
      scene::fogmap_from_columns(field, scene::ground_pixels(field, int(s.integer("pixels"))),
                                 int(s.integer("samples")), int(s.integer("degree")));
  Findings found;
  found.figures = {exactly("column_error", fog.column_error), exactly("density_error", fog.density_error),
                   exactly("column_ratio", fog.column_ratio)};
  found.counters = {{"coefficients", double(fog.map.map.coefficients().size())}};
  return found;
}

}  // namespace airlight::experiments
