#include "gpu/fogshop/surface_tables.h"

#include <cmath>

#include "methods/fogshop/harmonic_reflection.h"
#include "methods/fogshop/surface_psf.h"
#include "scene/math/sh_product.h"
#include "scene/math/sh_rotation.h"

namespace airlight::gpu::fogshop {
SurfaceTables::SurfaceTables(const scene::Scene& scene, const airlight::fogshop::SurfaceLighting& lighting) {
  add_materials(scene, lighting);
  if (lighting.points && lighting.points->sun()) add_sun(*lighting.points->sun());
  if (lighting.reflectances) add_harmonics(lighting);
  if (lighting.transfer) add_transfer(*lighting.transfer, lighting.reflectances->order());
  if (lighting.depths) add_depth_tree(*lighting.depths);
}

int SurfaceTables::add(const std::vector<double>& table) {
  const int place = int(values.size());
  for (const double v : table) values.push_back(float(v));
  return place;
}

int SurfaceTables::add(const std::vector<Rgb>& table) {
  const int place = int(values.size());
  for (const Rgb& v : table)
    for (int c = 0; c < 3; ++c) values.push_back(float(v[c]));
  return place;
}

void SurfaceTables::add_materials(const scene::Scene& scene, const airlight::fogshop::SurfaceLighting& lighting) {
  MaterialTables direct(scene);
  materials = std::move(direct.materials);
  values = std::move(direct.values);
  for (std::size_t i = 0; i < materials.size() && lighting.reflectances; ++i)
    if (const auto& table = lighting.reflectances->tables()[i]) {
      materials[i].places[0] = add(table->values());
      materials[i].places[1] = table->entries();
    }
}

void SurfaceTables::add_sun(const airlight::fogshop::SunReflection& sun) {
  uniforms["sun_at"] = add(sun.lambert().values());
  for (const auto& lobe : sun.lobes()) {
    const int place = add(lobe.along.values());
    add(lobe.across.values());
    for (MaterialData& data : materials)
      if (data.diffuse[3] == 1 && data.specular[3] == float(lobe.exponent) &&
          (data.specular[0] > 0 || data.specular[1] > 0 || data.specular[2] > 0))
        data.places[2] = place;
  }
}

void SurfaceTables::add_harmonics(const airlight::fogshop::SurfaceLighting& lighting) {
  const int order = lighting.reflectances->order(), size = order * order;
  uniforms["cosine_at"] = add(airlight::fogshop::clamped_cosine(order));
  const scene::ShQuarterTurn& turn = scene::sh_quarter_turn(order);
  uniforms["turn_at"] = add(std::vector<double>(turn.first.begin(), turn.first.end()));
  for (std::size_t k = 0; k < turn.column.size(); ++k) add(std::vector<double>{double(turn.column[k]), turn.value[k]});
  iterations += 6.0 * size + 2.0 * double(turn.column.size());
  if (lighting.points) {
    uniforms["point_bands_at"] = add(lighting.points->bands().values());
    uniforms["point_depths"] = lighting.points->bands().depths();
    light_iterations += 2.0 * size + 4.0 * order;
  }
  if (lighting.environment) {
    const std::vector<Rgb>& light = lighting.environment->light();
    uniforms["environment_at"] = add(light);
    // Reflected by Lambert's reflectance, without its albedo: zonal about the normal.
    const std::vector<double> cosine = airlight::fogshop::clamped_cosine(order);
    std::vector<Rgb> reflected;
    for (int l = 0; l < order; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        reflected.push_back(light[i] * (cosine[l] * std::sqrt(4 * pi / (2 * l + 1))));
    uniforms["environment_lambert_at"] = add(reflected);
    uniforms["environment_depths"] = 1;
    if (lighting.environment->spreads()) {
      uniforms["environment_bands_at"] = add(lighting.environment->bands().values());
      uniforms["environment_depths"] = lighting.environment->bands().depths();
    }
    iterations += size + 4.0 * order;
  }
}

// Places are floats, whole up to 2^24: fewer fit into a tree.
void SurfaceTables::add_depth_tree(const airlight::fogshop::DepthTree& tree) {
  uniforms["tree_children_at"] = add(std::vector<double>(tree.children().begin(), tree.children().end()));
  std::vector<double> cells;
  for (const airlight::fogshop::DepthCell& cell : tree.cells()) {
    cells.insert(cells.end(), cell.polynomial.coefficients.begin(), cell.polynomial.coefficients.end());
    cells.insert(cells.end(), {double(cell.begin), double(cell.end)});
  }
  uniforms["tree_cells_at"] = add(cells);
  uniforms["tree_lists_at"] = add(std::vector<double>(tree.listed().begin(), tree.listed().end()));
  iterations += 200;  // levels and coefficients
}

void SurfaceTables::add_transfer(const airlight::fogshop::RadianceTransfer& visibility, int order) {
  for (const std::vector<float>& of_surface : visibility.coefficients())
    transfer.insert(transfer.end(), of_surface.begin(), of_surface.end());
  uniforms["reflected_at"] = visibility.reflections().empty() ? -1 : int(transfer.size());
  for (const std::vector<float>& of_surface : visibility.reflections())
    transfer.insert(transfer.end(), of_surface.begin(), of_surface.end());
  // By the coefficient of the product: pairs i <= j of those of the factors.
  struct Term {
    int i, j;
    double value;
  };
  std::vector<std::vector<Term>> terms(std::size_t(order) * order);
  for (const auto& [i, j, k, value] : scene::triple_product(order).terms()) {  // i <= j <= k
    terms[k].push_back({i, j, value});
    if (j != k) terms[j].push_back({i, k, value});
    if (i != j) terms[i].push_back({j, k, value});
  }
  std::vector<double> first{0};
  std::vector<double> all;
  for (const std::vector<Term>& of_one : terms) {
    for (const Term& t : of_one) all.insert(all.end(), {double(t.i), double(t.j), t.value});
    first.push_back(double(all.size() / 3));
  }
  uniforms["product_at"] = add(first);
  add(all);
  iterations += 2.0 * order * order + double(all.size() / 3);
}

}  // namespace airlight::gpu::fogshop
