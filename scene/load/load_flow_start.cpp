// Loads the initial state of a flow: [start].
#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"
#include "scene/load/assets.h"
#include "scene/load/flow_parts.h"

namespace airlight::scene::load {
namespace {

StartVelocity read_velocity(TableReader reader) {
  const std::string type = reader.type({"rest", "taylor_green", "swirl", "rotation", "wind"});
  if (type == "taylor_green") {
    reader.allow({"type", "speed", "waves"});
    return TaylorGreen{reader.number("speed", speed, 1), int(reader.integer("waves", 1, 1024, 1))};
  }
  if (type == "swirl") {
    reader.allow({"type", "speed"});
    return Swirl{reader.number("speed", speed, 1)};
  }
  if (type == "rotation") {
    reader.allow({"type", "center", "rate"});
    return RigidRotation{reader.vector("center"), speeds(reader, "rate")};
  }
  if (type == "wind") {
    reader.allow({"type", "velocity", "gust", "frequency"});
    Wind wind{speeds(reader, "velocity")};
    if (reader.has("gust") || reader.has("frequency")) {
      wind.gust = speeds(reader, "gust");
      wind.frequency = reader.number("frequency", {1e-9, 1e9});
    }
    return wind;
  }
  reader.allow({"type"});
  return AtRest{};
}

Wave read_wave(TableReader reader) {
  reader.allow({"waves", "density", "offset", "phase"});
  Wave wave;
  const auto waves = reader.integers("waves", 3, -4096, 4096);
  wave.waves = {double(waves[0]), double(waves[1]), double(waves[2])};
  wave.density = reader.number("density", density_range);
  wave.offset = reader.number("offset", either_sign(density_range), 0);
  wave.phase = reader.number("phase", coordinate, 0);
  return wave;
}

void require_density(const TableReader& reader, const std::string& path, const VoxelGrid& grid) {
  require_near(reader, "file", grid);
  for (const float value : grid.values)
    if (value > density_range.greatest)
      reader.fail("file", fmt::format("{}: a density of {}, expected at most {}", path, value, density_range.greatest));
}

// Reads the file's grids, which are added to the other initial values: the named grids, or the density.
void read_start_file(const TableReader& reader, const std::string& folder, FlowProblem& problem) {
  const std::vector<std::string> others = {"temperature_grid", "velocity_grid"};
  const bool no_density = std::any_of(others.begin(), others.end(), [&](auto& key) { return reader.has(key); });
  const std::string path = find_asset(reader, "file", folder);
  try {
    if (reader.has("grid") || !no_density)
      problem.density_grid = std::make_shared<const VoxelGrid>(read_vdb(path, reader.text("grid", "density")));
    if (reader.has("temperature_grid"))
      problem.temperature_grid =
          std::make_shared<const VoxelGrid>(read_temperature_vdb(path, reader.text("temperature_grid")));
    if (reader.has("velocity_grid"))
      problem.velocity_grid =
          std::make_shared<const VelocityGrid>(read_velocity_vdb(path, reader.text("velocity_grid")));
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
  if (problem.density_grid) require_density(reader, path, *problem.density_grid);
  if (problem.temperature_grid) require_near(reader, "file", *problem.temperature_grid);
  if (problem.velocity_grid) require_near(reader, "file", problem.velocity_grid->front());
}

}  // namespace

int read_which(const TableReader& reader, const FlowProblem& problem) {
  if (!reader.has("of")) return 0;
  std::vector<std::string> names{"density"};
  for (const NamedDensity& d : problem.densities) names.push_back(d.name);
  const std::string name = reader.choice("of", names);
  return int(std::find(names.begin(), names.end(), name) - names.begin());
}

void read_density(TableReader reader, const std::string& folder, FlowProblem& problem) {
  reader.allow({"name", "density", "blob", "wave", "file", "grid"});
  NamedDensity own;
  own.name = reader.text("name");
  const bool plain =
      !own.name.empty() && own.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!plain) reader.expected("name", "small letters, digits and _: it becomes part of the names of files and grids");
  std::vector<std::string> taken{"density", "temperature", "velocity", "particles"};
  for (const NamedDensity& d : problem.densities) taken.push_back(d.name);
  if (std::find(taken.begin(), taken.end(), own.name) != taken.end())
    reader.fail("name", fmt::format("there is a {} already, expected another name", own.name));
  own.density = reader.number("density", {0, density_range.greatest}, 0);
  for (TableReader blob : reader.tables("blob")) {
    blob.allow({"center", "width", "density"});
    own.blobs.push_back(
        {blob.vector("center"), blob.number("width", length), blob.number("density", {0, density_range.greatest}), 0});
  }
  if (const auto wave = reader.table("wave")) own.wave = read_wave(*wave);
  if (!reader.has("file") && reader.has("grid")) reader.fail("grid", "grid has no effect: there is no file");
  if (reader.has("file")) {
    const std::string path = find_asset(reader, "file", folder);
    try {
      own.grid = std::make_shared<const VoxelGrid>(read_vdb(path, reader.text("grid", own.name)));
    } catch (const Error& e) {
      reader.fail("file", e.what());
    }
    require_density(reader, path, *own.grid);
  }
  problem.densities.push_back(std::move(own));
}

void read_start(TableReader reader, const std::string& folder, FlowProblem& problem) {
  reader.allow({"velocity", "velocity_stays", "density", "temperature", "blob", "wave", "file", "grid",
                "temperature_grid", "velocity_grid"});
  if (const auto velocity = reader.table("velocity")) problem.velocity = read_velocity(*velocity);
  problem.velocity_stays = reader.flag("velocity_stays", false);
  problem.density = reader.number("density", {0, density_range.greatest}, 0);
  problem.temperature = reader.number("temperature", temperatures, 0);
  for (TableReader blob : reader.tables("blob")) {
    blob.allow({"center", "width", "density", "temperature"});
    problem.blobs.push_back({blob.vector("center"), blob.number("width", length),
                             blob.number("density", {0, density_range.greatest}, 0),
                             blob.number("temperature", temperatures, 0)});
  }
  if (const auto wave = reader.table("wave")) problem.wave = read_wave(*wave);
  if (reader.has("file")) read_start_file(reader, folder, problem);
  for (const char* key : {"grid", "temperature_grid", "velocity_grid"})
    if (!reader.has("file") && reader.has(key))
      reader.fail(key, fmt::format("{} has no effect: there is no file", key));
}

}  // namespace airlight::scene::load
