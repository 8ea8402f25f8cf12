#include <fmt/format.h>

// Procedural shapes of a scene file: their keys, and the mesh that they become.
#include "scene/base/error.h"
#include "scene/geometry/city.h"
#include "scene/geometry/round_shapes.h"
#include "scene/geometry/teapot.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

constexpr long long most = 4096;              // vertices along one direction
constexpr long long most_vertices = 1 << 21;  // as many as those of a teapot of the greatest size

TriangleMesh read_displaced_sphere(TableReader& reader) {
  reader.allow(surface_keys_and({"center", "radius", "radii", "size", "waves", "bumps", "transform"}));
  DisplacedSphere sphere;
  sphere.center = reader.vector("center", Vec3(Vec3::Zero()));
  if (reader.one_of({"radius", "radii"}) == "radius") {
    sphere.radii.setConstant(reader.number("radius", length));
  } else {
    const auto radii = reader.numbers("radii", length, 3);
    sphere.radii = {radii[0], radii[1], radii[2]};
  }
  const auto size = read_mesh_size(reader, 3);
  sphere.around = int(size[0]);
  sphere.rings = int(size[1]);
  for (TableReader wave : reader.tables("waves")) {
    wave.allow({"amplitude", "wave_vector", "phase"});
    sphere.waves.push_back(
        {wave.number("amplitude", coordinate), wave.vector("wave_vector"), wave.number("phase", coordinate, 0)});
  }
  for (TableReader bump : reader.tables("bumps")) {
    bump.allow({"direction", "width", "height"});
    sphere.bumps.push_back(
        {bump.direction("direction"), bump.number("width", length), bump.number("height", coordinate)});
  }
  return make_displaced_sphere(sphere);
}

TriangleMesh read_torus(TableReader& reader) {
  reader.allow(surface_keys_and({"center", "axis", "radius", "tube_radius", "size", "transform"}));
  Torus torus;
  torus.center = reader.vector("center", Vec3(Vec3::Zero()));
  torus.axis = reader.direction("axis", Vec3(Vec3::UnitY()));
  torus.radius = reader.number("radius", length);
  torus.tube_radius = reader.number("tube_radius", {least_length, torus.radius, false, true});
  const auto size = read_mesh_size(reader, 3);
  torus.around = int(size[0]);
  torus.across = int(size[1]);
  return make_torus(torus);
}

TriangleMesh read_tube(TableReader& reader) {
  reader.allow(surface_keys_and({"path", "radius", "end_radius", "size", "caps", "transform"}));
  Tube tube;
  for (const Rgb& point : reader.colors("path", coordinate)) tube.path.push_back(point.matrix());
  if (tube.path.size() < 2) reader.expected("path", "at least 2 points");
  tube.radius = reader.number("radius", length);
  tube.end_radius = reader.number("end_radius", length, tube.radius);
  const auto size = read_mesh_size(reader, 2);
  if (size[1] < 3) reader.expected("size", "at least 3 vertices around");
  tube.along = int(size[0]);
  tube.around = int(size[1]);
  tube.caps = reader.flag("caps", true);
  return make_tube(tube);
}

TriangleMesh read_prism(TableReader& reader) {
  reader.allow(surface_keys_and({"base", "sides", "radius", "top_radius", "height", "caps", "transform"}));
  Prism prism;
  prism.base = reader.vector("base", Vec3(Vec3::Zero()));
  prism.sides = int(reader.integer("sides", 3, most));
  prism.radius = reader.number("radius", length);
  prism.top_radius = reader.number("top_radius", length, prism.radius);
  prism.height = reader.number("height", length);
  prism.caps = reader.flag("caps", true);
  return make_prism(prism);
}

TriangleMesh read_city(TableReader& reader) {
  reader.allow(
      surface_keys_and({"origin", "boxes", "columns", "block", "lot", "street", "heights", "seed", "transform"}));
  City city;
  city.origin = reader.vector("origin", Vec3(Vec3::Zero()));
  city.boxes = int(reader.integer("boxes", 1, 100'000));
  city.columns = int(reader.integer("columns", 1, 10'000));
  city.block = int(reader.integer("block", 1, 10'000, city.block));
  city.lot = reader.number("lot", length);
  city.street = reader.number("street", length_or_zero);
  const auto heights = reader.numbers("heights", length, 2);
  if (!(heights[0] <= heights[1])) reader.expected("heights", "[least, greatest]");
  city.least_height = heights[0];
  city.greatest_height = heights[1];
  city.seed = std::uint32_t(reader.integer("seed", 0, 0xFFFFFFFFll, 0));
  return make_city(city);
}

}  // namespace

const std::vector<std::string>& procedural_types() {
  static const std::vector<std::string> types = {"displaced_sphere", "torus", "tube", "prism", "teapot", "city"};
  return types;
}

std::vector<long long> read_mesh_size(TableReader& reader, int least) {
  const auto size = reader.integers("size", 2, least, most);
  if (size[0] * size[1] > most_vertices)
    reader.expected("size", fmt::format("at most {} vertices in all", most_vertices));
  return {size.begin(), size.end()};
}

TriangleMesh read_procedural(const std::string& type, TableReader& reader) {
  try {
    if (type == "displaced_sphere") return read_displaced_sphere(reader);
    if (type == "torus") return read_torus(reader);
    if (type == "tube") return read_tube(reader);
    if (type == "prism") return read_prism(reader);
    if (type == "city") return read_city(reader);
    reader.allow(surface_keys_and({"size", "transform"}));
    return make_teapot(int(reader.integer("size", 2, 256)));
  } catch (const Error& e) {
    // The shape's own error messages do not know the position in the file.
    if (std::string(e.what()).find(reader.where()) != std::string::npos) throw;
    reader.fail("", e.what());
  }
}

}  // namespace airlight::scene::load
