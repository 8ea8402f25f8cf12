#include <fmt/format.h>

#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"

namespace airlight::scene::load {
namespace {

PhaseFunction read_phase(TableReader reader) {
  const std::string type = reader.type({"isotropic", "rayleigh", "hg", "hazy", "murky"});
  if (type == "hg") {
    reader.allow({"type", "g"});
    return HenyeyGreenstein{reader.number("g", anisotropy)};
  }
  reader.allow({"type"});
  if (type == "rayleigh") return Rayleigh{};
  if (type == "hazy") return Hazy{};
  if (type == "murky") return Murky{};
  return Isotropic{};
}

Region read_region(TableReader reader) {
  const std::string type = reader.type({"unbounded", "box", "sphere", "slab"});
  if (type == "box") {
    reader.allow({"type", "lo", "hi"});
    return read_corners(reader);
  }
  if (type == "sphere") {
    reader.allow({"type", "center", "radius"});
    return Sphere{reader.vector("center"), reader.number("radius", length)};
  }
  if (type == "slab") {
    reader.allow({"type", "normal", "lo", "hi"});
    const Slab slab{reader.direction("normal", Vec3::UnitY()), reader.number("lo", coordinate),
                    reader.number("hi", coordinate)};
    if (!(slab.hi - slab.lo >= least_length))
      reader.expected("hi", fmt::format("a number {} m or more above 'lo'", least_length));
    return slab;
  }
  reader.allow({"type"});
  return Unbounded{};
}

// Allows the keys of this type and of every medium, for the reads that follow.
DensityField read_field(const std::string& type, TableReader& reader, const std::string& folder) {
  if (type == "gaussians") return read_gaussian_sum(reader, folder);
  if (type == "grid") return read_grid(reader, folder);
  reader.allow(medium_keys_and({"density"}));
  return Homogeneous{reader.number("density", density_range, 1)};
}

}  // namespace

std::vector<std::string> medium_keys_and(const std::vector<std::string>& keys) {
  std::vector<std::string> all = {"name", "type", "sigma_t", "albedo", "phase", "region"};
  all.insert(all.end(), keys.begin(), keys.end());
  return all;
}

Medium read_medium(TableReader reader, const std::string& folder) {
  const std::string type = reader.type({"homogeneous", "gaussians", "grid"});
  Medium medium;
  medium.field = read_field(type, reader, folder);
  medium.name = reader.text("name", "");
  medium.sigma_t = reader.color("sigma_t", amount, Rgb::Ones());
  require_extinction(reader, medium);
  medium.albedo = reader.color("albedo", share, Rgb::Ones());
  if (const auto phase = reader.table("phase")) medium.phase = read_phase(*phase);
  if (const auto region = reader.table("region")) medium.region = read_region(*region);
  return medium;
}

}  // namespace airlight::scene::load
