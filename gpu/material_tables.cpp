#include "gpu/material_tables.h"

#include "scene/geometry/brdf_table.h"

namespace airlight::gpu {
namespace {

std::array<float, 4> float4(const Rgb& color, double w) {
  return {float(color[0]), float(color[1]), float(color[2]), float(w)};
}

}  // namespace

MaterialTables::MaterialTables(const scene::Scene& scene) {
  for (const scene::Surface& surface : scene.surfaces) {
    MaterialData data{};
    data.places[2] = -1;
    const scene::Material& material = surface.material;
    if (const auto* lambert = std::get_if<scene::Lambert>(&material)) {
      data.diffuse = float4(lambert->albedo, 0);
    } else if (const auto* phong = std::get_if<scene::Phong>(&material)) {
      data.diffuse = float4(phong->diffuse, 1);
      data.specular = float4(phong->specular, phong->exponent);
    } else {
      const scene::BrdfTable& table = *std::get<scene::Tabulated>(material).table;
      data.diffuse = float4(Rgb::Ones(), 2);
      data.table = {int(values.size()), table.thetas(), table.phis(), 0};
      for (const Rgb& v : table.values())
        for (int c = 0; c < 3; ++c) values.push_back(float(v[c]));
    }
    materials.push_back(data);
  }
}

}  // namespace airlight::gpu
