#include <fmt/format.h>

#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene::load {
namespace {

PhaseFunction read_phase(TableReader reader) {
  const PhaseFunction kind = read_kind(reader, phase_name);
  const auto plain = [&] {
    reader.allow({"type"});
    return kind;
  };
  return match(
      kind, [&](Isotropic) { return plain(); }, [&](Rayleigh) { return plain(); },
      [&](HenyeyGreenstein) -> PhaseFunction {
        reader.allow({"type", "g"});
        return HenyeyGreenstein{reader.number("g", anisotropy)};
      },
      [&](Hazy) { return plain(); }, [&](Murky) { return plain(); });
}

Slab read_slab(TableReader& reader) {
  reader.allow({"type", "normal", "lo", "hi"});
  Slab slab{reader.direction("normal", Vec3::UnitY()), reader.number("lo", coordinate),
            reader.number("hi", coordinate)};
  if (!(slab.hi - slab.lo >= least_length))
    reader.expected("hi", fmt::format("a number {} m or more above 'lo'", least_length));
  return slab;
}

// Allows the keys of this kind and of every medium, for the reads that follow.
DensityField read_field(const DensityField& kind, TableReader& reader, const std::string& folder) {
  return match(
      kind,
      [&](const Homogeneous&) -> DensityField {
        reader.allow(medium_keys_and({"density"}));
        return Homogeneous{reader.number("density", density_range, 1)};
      },
      [&](const GaussianSum&) -> DensityField { return read_gaussian_sum(reader, folder); },
      [&](const GridPointer&) -> DensityField { return read_grid(reader, folder); },
      [&](const FogmapPointer&) -> DensityField { return read_fogmap(reader, folder); },
      [&](const LegendrePointer&) -> DensityField { return read_legendre(reader, folder); },
      [&](const FittedPointer&) -> DensityField { return read_fitted(reader, folder); });
}

}  // namespace

Region read_region(TableReader reader) {
  const Region kind = read_kind(reader, region_name);
  return match(
      kind,
      [&](const Unbounded&) -> Region {
        reader.allow({"type"});
        return Unbounded{};
      },
      [&](const Box&) -> Region {
        reader.allow({"type", "lo", "hi"});
        return read_corners(reader);
      },
      [&](const Sphere&) -> Region {
        reader.allow({"type", "center", "radius"});
        return Sphere{reader.vector("center"), reader.number("radius", length)};
      },
      [&](const Slab&) -> Region { return read_slab(reader); });
}

std::vector<std::string> medium_keys_and(const std::vector<std::string>& keys) {
  std::vector<std::string> all = {"name", "type", "sigma_t", "albedo", "phase", "region"};
  all.insert(all.end(), keys.begin(), keys.end());
  return all;
}

Medium read_medium(TableReader reader, const std::string& folder) {
  const DensityField kind = read_kind(reader, field_name);
  Medium medium;
  medium.field = read_field(kind, reader, folder);
  medium.name = reader.text("name", "");
  medium.sigma_t = reader.color("sigma_t", amount, Rgb::Ones());
  require_extinction(reader, medium);
  medium.albedo = reader.color("albedo", share, Rgb::Ones());
  if (const auto phase = reader.table("phase")) medium.phase = read_phase(*phase);
  if (const auto region = reader.table("region")) medium.region = read_region(*region);
  if (const Box box = bounding_box(medium);
      std::holds_alternative<FogmapPointer>(medium.field) && !(box.size().array() < infinity).all())
    reader.fail(reader.has("region") ? "region" : "",
                "a fogmap without an end in height, expected a region that bounds it");
  return medium;
}

}  // namespace airlight::scene::load
