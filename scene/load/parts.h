// The parts of a scene file, each read from its table. scene/README.md is the user's description of all of them.
//
// `folder` is where the scene file lies: files that it names are looked for there first.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "scene/load/table_reader.h"
#include "scene/math/legendre.h"
#include "scene/scene.h"

namespace airlight::scene::load {

Camera read_camera(TableReader);
Light read_light(TableReader, const std::string& folder);
EnvironmentLight read_environment(TableReader, const std::string& folder);
Medium read_medium(TableReader, const std::string& folder);
Surface read_surface(TableReader, const std::string& folder);
Region read_region(TableReader);
std::shared_ptr<const Backdrop> read_backdrop(TableReader, const std::string& folder, const Camera&);
// The particles as the scene's camera sees them on its film.
std::shared_ptr<const Backdrop> read_particles(TableReader, const std::string& folder, const Scene&);

// The kind that the key `type` names, as it is by default; `name` names a kind.
template <class Variant>
Variant read_kind(TableReader& reader, std::string (*name)(const Variant&)) {
  const std::vector<Variant> kinds = Kinds<Variant>::all();
  std::vector<std::string> names;
  for (const Variant& kind : kinds) names.push_back(name(kind));
  const std::string type = reader.type(names);
  return kinds[std::size_t(std::find(names.begin(), names.end(), type) - names.begin())];
}

// Fields of media. The reader is the medium's; they allow their own keys beside those of every medium.
GaussianSum read_gaussian_sum(TableReader&, const std::string& folder);
GridPointer read_grid(TableReader&, const std::string& folder);
FogmapPointer read_fogmap(TableReader&, const std::string& folder);
LegendrePointer read_legendre(TableReader&, const std::string& folder);
FittedPointer read_fitted(TableReader&, const std::string& folder);

// The Gaussians of a CSV file. Throws Error (file, line, column).
// Their ids into `ids`, if the table has some; else that is empty.
std::vector<Gaussian> read_gaussians_csv(const std::string& path, std::vector<int>* ids = nullptr);

// The coefficients of a CSV file, in the order of LegendreBox. Throws Error (file, line, column).
Eigen::VectorXd read_legendre_csv(const std::string& path, const TensorShape&);

// Surfaces that become meshes by a rule (load_shapes.cpp): their types; the mesh of one of them, before `transform`.
const std::vector<std::string>& procedural_types();
TriangleMesh read_procedural(const std::string& type, TableReader&);
// Vertices along and across of a mesh by a rule, `size`: each from `least` to 4096, and no more than 2^21 of them in
// all, which take 1.1 GB once rays can meet them.
std::vector<long long> read_mesh_size(TableReader&, int least);

// `keys` and those of every medium, of every surface.
std::vector<std::string> medium_keys_and(const std::vector<std::string>& keys);
std::vector<std::string> surface_keys_and(const std::vector<std::string>& keys);

}  // namespace airlight::scene::load
