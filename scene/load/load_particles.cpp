// [[particles]]: positions from a file or at random, drawn as the scene's camera sees them.
#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/flow/particles.h"
#include "scene/flow/random_points.h"
#include "scene/load/assets.h"
#include "scene/load/csv_table.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

constexpr int most_particles = 1 << 20;

std::vector<Point3> read_csv(const TableReader& reader, const std::string& folder) {
  const std::string path = find_asset(reader, "file", name_of_frame(reader), folder);
  const auto set = double(reader.integer("set", 0, 1'000'000, 0));
  std::vector<Point3> positions;
  try {
    CsvTable table(path, particle_header);
    while (table.next()) {
      const auto row = table.values({{0, 1e6}, coordinate, coordinate, coordinate});
      if (row[0] == set) positions.emplace_back(row[1], row[2], row[3]);
      if (positions.size() > std::size_t(most_particles))
        table.fail(0, fmt::format("more than {} particles", most_particles));
    }
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
  if (positions.empty()) reader.expected("file", fmt::format("a file with particles of set {:g}", set));
  return positions;
}

std::vector<Point3> read_random(const TableReader& reader) {
  const auto count = std::size_t(reader.integer("count", 1, most_particles));
  const Region region = read_region(reader.required_table("region"));
  const Box box = bounding_box(region);
  if (!box.size().allFinite()) reader.expected("region", "a region with an end on all sides");
  try {
    return random_points(region, box, count, std::uint32_t(reader.integer("seed", 0, 0xffffffffLL, 0)));
  } catch (const Error& e) {
    reader.fail("region", e.what());
  }
}

}  // namespace

std::shared_ptr<const Backdrop> read_particles(TableReader reader, const std::string& folder, const Scene& scene) {
  const bool disc = reader.type({"disc", "sheet"}) == "disc";
  const auto allow = [&](std::vector<std::string> keys) {
    for (const char* key : {"type", "radius", "radiance", "seed"}) keys.emplace_back(key);
    if (!disc) keys.emplace_back("turn");
    reader.allow(keys);
  };
  allow({"file", "frame", "set", "count", "region"});
  const bool from_file = reader.one_of({"file", "count"}) == "file";
  from_file ? allow({"file", "frame", "set"}) : allow({"count", "region"});
  Particles particles;
  particles.shape = disc ? Particles::Shape::disc : Particles::Shape::sheet;
  particles.positions = from_file ? read_csv(reader, folder) : read_random(reader);
  particles.radius = reader.number("radius", length);
  particles.radiances = reader.colors("radiance", amount);
  if (particles.radiances.empty()) reader.expected("radiance", "a list of at least one [r, g, b]");
  particles.seed = std::uint32_t(reader.integer("seed", 0, 0xffffffffLL, 0));
  if (!disc && from_file && reader.has("frame"))
    particles.angle = reader.number("turn", coordinate, 0.3) * double(reader.integer("frame", 0, 999'999'999));
  else if (!disc)
    particles.angle = reader.number("turn", coordinate, 0);
  return std::make_shared<const Backdrop>(draw(particles, scene.camera, scene.width, scene.height));
}

}  // namespace airlight::scene::load
