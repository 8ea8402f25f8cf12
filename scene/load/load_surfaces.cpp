#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"
#include "scene/geometry/brdf_table.h"
#include "scene/geometry/mesh_io.h"
#include "scene/geometry/shapes.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"

namespace airlight::scene::load {
namespace {

Tabulated read_tabulated(TableReader& reader, const std::string& folder) {
  reader.allow({"type", "file"});
  const std::string path = find_asset(reader, "file", folder);
  try {
    return {std::make_shared<const BrdfTable>(read_brdf_table(path))};
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
}

Material read_material(TableReader reader, const std::string& folder) {
  const std::string type = reader.type({"lambert", "phong", "tabulated"});
  if (type == "tabulated") return read_tabulated(reader, folder);
  if (type == "lambert") {
    reader.allow({"type", "albedo"});
    return Lambert{reader.color("albedo", share, Lambert{}.albedo)};
  }
  reader.allow({"type", "diffuse", "specular", "exponent"});
  const Phong phong{reader.color("diffuse", share, Phong{}.diffuse), reader.color("specular", share, Phong{}.specular),
                    reader.number("exponent", exponent_range, Phong{}.exponent)};
  // The sum of two decimal fractions that make 1 may exceed 1 by a rounding.
  if (!((phong.diffuse + phong.specular) <= 1 + 1e-12).all())
    reader.fail("specular", fmt::format("diffuse + specular = [{}, {}, {}], expected at most 1: it would create energy",
                                        phong.diffuse[0] + phong.specular[0], phong.diffuse[1] + phong.specular[1],
                                        phong.diffuse[2] + phong.specular[2]));
  return phong;
}

TriangleMesh transformed(TriangleMesh mesh, const TableReader& reader) {
  const bool moved = reader.has("transform");
  if (moved) {
    const Similarity transform = read_transform(reader, "transform");
    for (Point3& vertex : mesh.vertices) vertex = transform(vertex);
  }
  require_near(reader, moved ? "transform" : "", mesh);
  return mesh;
}

TriangleMesh read_mesh_file(TableReader& reader, const std::string& folder) {
  reader.allow(surface_keys_and({"file", "transform"}));
  const std::string path = find_asset(reader, "file", folder);
  TriangleMesh mesh;
  try {
    mesh = read_mesh(path);
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
  return transformed(std::move(mesh), reader);
}

TriangleMesh read_box(TableReader& reader) {
  reader.allow(surface_keys_and({"lo", "hi", "transform"}));
  return transformed(make_box(read_corners(reader)), reader);
}

// The sum over the waves of amplitude * sin(wave_vector . (x, z) + phase), x and z measured from the origin.
std::vector<double> wave_heights(const TableReader& reader, const HeightField& field) {
  std::vector<double> heights(std::size_t(field.nx) * field.nz, 0.0);
  for (TableReader wave : reader.tables("waves")) {
    wave.allow({"amplitude", "wave_vector", "phase"});
    const double amplitude = wave.number("amplitude", coordinate);
    const auto k = wave.numbers("wave_vector", coordinate, 2);
    const double phase = wave.number("phase", coordinate, 0);
    for (int row = 0; row < field.nz; ++row)
      for (int column = 0; column < field.nx; ++column)
        heights[column + std::size_t(field.nx) * row] +=
            amplitude * std::sin(k[0] * column * field.spacing_x + k[1] * row * field.spacing_z + phase);
  }
  return heights;
}

TriangleMesh read_height_field(TableReader& reader) {
  reader.allow(surface_keys_and({"origin", "size", "spacing", "heights", "waves", "transform"}));
  HeightField field;
  field.origin = reader.vector("origin", Vec3(Vec3::Zero()));
  const auto size = read_mesh_size(reader, 2);
  field.nx = int(size[0]);
  field.nz = int(size[1]);
  const auto spacing = reader.numbers("spacing", length, 2);
  field.spacing_x = spacing[0];
  field.spacing_z = spacing[1];
  if (reader.one_of({"heights", "waves"}) == "heights") {
    field.heights = reader.numbers("heights", coordinate);
    if (field.heights.size() != std::size_t(field.nx) * field.nz)
      reader.fail("heights", fmt::format("heights has {} numbers, expected {} = {} x {}, x fastest",
                                         field.heights.size(), std::size_t(field.nx) * field.nz, field.nx, field.nz));
  } else {
    field.heights = wave_heights(reader, field);
  }
  return transformed(make_height_field(field), reader);
}

Shape read_shape(const std::string& type, TableReader& reader, const std::string& folder) {
  if (type == "mesh") return read_mesh_file(reader, folder);
  if (type == "box") return read_box(reader);
  if (type == "height_field") return read_height_field(reader);
  if (type == "sphere") {
    reader.allow(surface_keys_and({"center", "radius"}));
    return Sphere{reader.vector("center"), reader.number("radius", length)};
  }
  if (type != "plane") return transformed(read_procedural(type, reader), reader);
  reader.allow(surface_keys_and({"point", "normal"}));
  return Plane{reader.vector("point"), reader.direction("normal", Vec3::UnitY())};
}

}  // namespace

std::vector<std::string> surface_keys_and(const std::vector<std::string>& keys) {
  std::vector<std::string> all = {"name", "type", "material"};
  all.insert(all.end(), keys.begin(), keys.end());
  return all;
}

Surface read_surface(TableReader reader, const std::string& folder) {
  std::vector<std::string> types = {"mesh", "sphere", "box", "plane", "height_field"};
  types.insert(types.end(), procedural_types().begin(), procedural_types().end());
  const std::string type = reader.type(types);
  Surface surface;
  surface.shape = read_shape(type, reader, folder);
  surface.name = reader.text("name", "");
  if (const auto material = reader.table("material")) surface.material = read_material(*material, folder);
  return surface;
}

}  // namespace airlight::scene::load
