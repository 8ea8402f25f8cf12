// A flow problem: a file with a [flow], its sides, what there is at first, what comes in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "scene/base/error.h"
#include "scene/flow/flow_problem.h"
#include "scene/load/assets.h"
#include "scene/load/flow_parts.h"
#include "scene/load/overrides.h"
#include "scene/load/parse_toml.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"

namespace airlight::scene {
using namespace load;

namespace load {

Vec3 speeds(const TableReader& reader, const std::string& key) {
  const auto v = reader.numbers(key, speed, 3);
  return {v[0], v[1], v[2]};
}

}  // namespace load

namespace {

constexpr Range seconds = or_zero({1e-9, 1e9}), rate = either_sign(amount);
constexpr double most_frames = 1e7;

void read_box(TableReader reader, FlowProblem& problem) {
  reader.allow({"lo", "hi"});
  if (problem.dimensions == 3) {
    problem.box = read_corners(reader);
    return;
  }
  const auto lo = reader.numbers("lo", coordinate, 2), hi = reader.numbers("hi", coordinate, 2);
  for (int a = 0; a < 2; ++a)
    if (!(hi[a] - lo[a] >= least_length)) reader.expected("hi", "each number above that of lo");
  problem.box = {Point3(lo[0], lo[1], 0), Point3(hi[0], hi[1], 0)};
}

// `of` says which density the table brings.
void require_of(const TableReader& reader, bool brings) {
  if (reader.has("of") && !brings) reader.fail("of", "of has no effect: there is no density");
}

const std::vector<std::string> side_names = {"left", "right", "bottom", "top", "back", "front"};

Side read_side(TableReader reader, const FlowProblem& problem, int axis, int which) {
  Side side;
  const std::string type = reader.type({"periodic", "free_slip", "no_slip", "open", "moving", "inflow"});
  if (type == "moving") {
    reader.allow({"type", "velocity", "regularized"});
    side.velocity = speeds(reader, "velocity");
    if (side.velocity[axis] != 0)
      reader.expected("velocity", fmt::format("0 along {}: a wall moves in its plane", "xyz"[axis]));
    side.regularized = reader.flag("regularized", false);
  } else if (type == "inflow") {
    reader.allow({"type", "velocity", "density", "temperature", "of"});
    side.velocity = speeds(reader, "velocity");
    if (side.velocity[axis] == 0)
      reader.expected("velocity", fmt::format("a number other than 0 along {}, out of the box where it points outwards",
                                              "xyz"[axis]));
    side.density = reader.number("density", {0, density_range.greatest}, 0);
    side.temperature = reader.number("temperature", temperatures, 0);
    side.of = read_which(reader, problem);
    require_of(reader, side.density != 0);
    const bool inwards = which == 0 ? side.velocity[axis] > 0 : side.velocity[axis] < 0;
    for (const char* key : {"density", "temperature"})
      if (!inwards && reader.has(key))
        reader.fail(key, fmt::format("{} has no effect: the velocity points outwards", key));
  } else {
    reader.allow({"type"});
  }
  side.kind = type == "periodic"    ? Side::Kind::periodic
              : type == "free_slip" ? Side::Kind::free_slip
              : type == "open"      ? Side::Kind::open
                                    : Side::Kind::no_slip;
  return side;
}

// Inflow and outflow must be balanced unless a side is open. With obstacles the solver checks again, since only it
// knows which openings they close.
void require_balance(const TableReader& sides, const FlowProblem& problem) {
  double net = 0, gross = 0;
  for (int axis = 0; axis < problem.dimensions; ++axis) {
    double area = 1;
    for (int a = 0; a < problem.dimensions; ++a)
      if (a != axis) area *= problem.box.size()[a];
    for (int which = 0; which < 2; ++which) {
      const Side& side = problem.sides[axis][which];
      if (side.kind == Side::Kind::open) return;
      const double flux = (which == 0 ? 1 : -1) * side.velocity[axis] * area;
      net += flux;
      gross += std::abs(flux);
    }
  }
  if (std::abs(net) > 1e-9 * gross)
    sides.fail("",
               fmt::format("{:.6g} {} flow {} the box, and no side is open, expected as much in as out", std::abs(net),
                           problem.dimensions == 2 ? "m^2/s" : "m^3/s", net > 0 ? "into" : "out of"));
}

void read_sides(const TableReader& root, FlowProblem& problem) {
  const auto table = root.table("sides");
  if (!table) return;
  TableReader reader = *table;
  std::vector<std::string> keys(side_names.begin(), side_names.begin() + 2 * problem.dimensions);
  keys.push_back("all");
  reader.allow(keys);
  for (int axis = 0; axis < problem.dimensions; ++axis)
    for (int which = 0; which < 2; ++which) {
      const std::string& name = side_names[2 * axis + which];
      Side& side = problem.sides[axis][which];
      if (const auto all = reader.table("all")) side = read_side(*all, problem, axis, which);
      if (const auto own = reader.table(name)) side = read_side(*own, problem, axis, which);
    }
  for (int axis = 0; axis < problem.dimensions; ++axis)
    if ((problem.sides[axis][0].kind == Side::Kind::periodic) != (problem.sides[axis][1].kind == Side::Kind::periodic))
      reader.fail("", fmt::format("{} and {} are opposite sides, expected both periodic or none", side_names[2 * axis],
                                  side_names[2 * axis + 1]));
  if (!root.has("obstacle")) require_balance(reader, problem);
}

Interval read_time(const TableReader& reader) {
  const Interval time{reader.number("from", seconds, 0),
                      reader.number("to", {0, infinity, false, false, true}, infinity)};
  if (!(time.lo < time.hi)) reader.expected("to", fmt::format("a time after {} s", time.lo));
  return time;
}

// Reads a region that must overlap the box.
Region read_place(const TableReader& reader, const FlowProblem& problem) {
  Region region = read_region(reader.required_table("region"));
  const Box part = intersect(bounding_box(region), problem.box);
  if (part.empty()) reader.fail("region", "region lies outside the box of the flow");
  return region;
}

Source read_source(TableReader reader, const FlowProblem& problem) {
  reader.allow(
      {"region", "from", "to", "density_rate", "temperature_rate", "density", "temperature", "velocity", "of"});
  Source source;
  source.region = read_place(reader, problem);
  source.time = read_time(reader);
  source.density_rate = reader.number("density_rate", rate, 0);
  source.temperature_rate = reader.number("temperature_rate", rate, 0);
  if (reader.has("density")) source.density = reader.number("density", {0, density_range.greatest});
  if (reader.has("temperature")) source.temperature = reader.number("temperature", temperatures);
  if (reader.has("velocity")) source.velocity = speeds(reader, "velocity");
  source.of = read_which(reader, problem);
  require_of(reader, source.density_rate != 0 || source.density);
  if (source.density_rate == 0 && source.temperature_rate == 0 && !source.density && !source.temperature &&
      !source.velocity)
    reader.fail("", "nothing comes from it, expected density_rate, temperature_rate, density, temperature or velocity");
  return source;
}

Push read_push(TableReader reader, const FlowProblem& problem) {
  reader.allow({"region", "from", "to", "acceleration", "frequency"});
  Push push;
  if (reader.has("region")) push.region = read_place(reader, problem);
  push.time = read_time(reader);
  push.acceleration = speeds(reader, "acceleration");
  push.frequency = reader.number("frequency", or_zero({1e-9, 1e9}), 0);
  return push;
}

ParticleSet read_particle_set(TableReader reader, const FlowProblem& problem) {
  reader.allow({"count", "region", "seed", "fall", "leaving"});
  ParticleSet set;
  set.count = int(reader.integer("count", 1, 1 << 20));
  if (reader.has("region")) set.region = read_place(reader, problem);
  set.seed = std::uint32_t(reader.integer("seed", 0, 0xffffffffLL, 0));
  if (reader.has("fall")) set.fall = speeds(reader, "fall");
  const std::string leaving = reader.choice("leaving", {"stay", "wrap", "respawn"}, "stay");
  set.leaving = leaving == "wrap"      ? ParticleSet::Leaving::wrap
                : leaving == "respawn" ? ParticleSet::Leaving::respawn
                                       : ParticleSet::Leaving::stay;
  return set;
}

// Every edge of a closed mesh is passed as often one way as the other.
bool closed(const TriangleMesh& mesh) {
  std::multiset<std::pair<int, int>> open;
  for (const auto& t : mesh.triangles)
    for (int e = 0; e < 3; ++e) {
      const int a = t[e], b = t[(e + 1) % 3];
      if (const auto opposite = open.find({b, a}); opposite != open.end())
        open.erase(opposite);
      else
        open.insert({a, b});
    }
  return open.empty();
}

// Where the box of the flow has nothing of it, or nothing beside it.
void require_part(const TableReader& reader, const Surface& surface, const Box& flow) {
  Box bounds;
  match(
      surface.shape, [&](const Sphere& s) { bounds = bounding_box(Region(s)); },
      [&](const TriangleMesh& mesh) {
        for (const Point3& vertex : mesh.vertices) bounds = unite(bounds, {vertex, vertex});
      },
      [](const Plane&) {});
  if (intersect(bounds, flow).empty()) reader.fail("", "this surface lies outside the box of the flow");
  if (const Sphere* s = std::get_if<Sphere>(&surface.shape)) {
    const Vec3 farthest = (flow.lo - s->center).cwiseAbs().cwiseMax((flow.hi - s->center).cwiseAbs());
    if (farthest.norm() <= s->radius) reader.fail("", "this sphere fills the box, expected a part of it for the fluid");
  }
}

Surface read_obstacle(const TableReader& reader, const std::string& folder, const FlowProblem& problem) {
  Surface surface = read_surface(reader, folder);
  const bool solid = match(
      surface.shape, [](const TriangleMesh& mesh) { return closed(mesh); }, [](const Sphere&) { return true; },
      [](const Plane&) { return false; });
  if (!solid) reader.fail("", "this surface encloses nothing, expected a sphere, a box or a closed mesh");
  require_part(reader, surface, problem.box);
  return surface;
}

}  // namespace

FlowProblem parse_flow(const std::string& text, const std::string& name, const std::string& folder,
                       const Overrides& overrides) {
  toml::table root = parse_toml(text, name);
  apply_overrides(root, overrides, name, {"fluid", "start"});
  TableReader reader(root, "");
  reader.allow({"name", "flow", "sides", "fluid", "start", "density", "source", "obstacle", "force", "particles"});
  FlowProblem problem;
  problem.file = name;
  problem.name = reader.file_name("name", std::filesystem::path(name).stem().string());
  TableReader flow = reader.required_table("flow");
  flow.allow({"dimensions", "box", "duration", "frame_rate"});
  problem.dimensions = int(flow.integer("dimensions", 2, 3, 3));
  read_box(flow.required_table("box"), problem);
  problem.duration = flow.number("duration", {1e-9, 1e9});
  problem.frame_rate = flow.number("frame_rate", {1e-9, 1e9}, problem.frame_rate);
  if (problem.duration * problem.frame_rate > most_frames)
    flow.expected("duration",
                  fmt::format("at most {:.0e} frames, {:g} of them a second", most_frames, problem.frame_rate));
  for (const TableReader& density : reader.tables("density")) read_density(density, folder, problem);
  read_sides(reader, problem);
  if (auto fluid = reader.table("fluid")) {
    fluid->allow({"viscosity", "diffusivity", "decay", "gravity", "weight", "expansion", "confinement"});
    problem.viscosity = fluid->number("viscosity", amount, 0);
    problem.diffusivity = fluid->number("diffusivity", amount, 0);
    problem.decay = fluid->number("decay", amount, 0);
    if (fluid->has("gravity")) problem.gravity = speeds(*fluid, "gravity");
    problem.weight = fluid->number("weight", signed_amount, 0);
    problem.expansion = fluid->number("expansion", signed_amount, 0);
    problem.confinement = fluid->number("confinement", or_zero({1e-9, 1e9}), 0);
  }
  if (const auto start = reader.table("start")) read_start(*start, folder, problem);
  for (const TableReader& source : reader.tables("source")) problem.sources.push_back(read_source(source, problem));
  for (const TableReader& obstacle : reader.tables("obstacle"))
    problem.obstacles.push_back(read_obstacle(obstacle, folder, problem));
  for (const TableReader& push : reader.tables("force")) problem.pushes.push_back(read_push(push, problem));
  for (const TableReader& set : reader.tables("particles"))
    problem.particles.push_back(read_particle_set(set, problem));
  problem.hash = content_hash(problem);
  return problem;
}

FlowProblem load_flow(const std::string& path, const Overrides& overrides) {
  return parse_flow(read_whole_file(path, most_toml_bytes), path, std::filesystem::path(path).parent_path().string(),
                    overrides);
}

}  // namespace airlight::scene
