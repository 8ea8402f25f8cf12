// A flow problem: an incompressible fluid of constant density in a box, and the quantities that it carries along.
//
//   u_t = -(u.grad)u - grad p + viscosity lap u + f,   div u = 0
//   d_t = -u.grad d + diffusivity lap d - decay d + sources,  and the same for the temperature
//
// f is the acceleration by buoyancy, confinement of vorticity and forces [m/s^2]; p is pressure over density [m^2/s^2].
// `density` is that of smoke [-], as in the media of scenes; `temperature` is the excess over the surroundings [K].
#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"
#include "scene/media/region.h"
#include "scene/media/start_grids.h"
#include "scene/scene.h"

namespace airlight::scene {

// A side of the box, and what the fluid does there.
struct Side {
  enum class Kind {
    periodic,   // both sides of an axis
    free_slip,  // nothing passes, nothing rubs
    no_slip,    // the fluid moves as the wall does: still, a lid, or an inflow where the velocity points inwards
    open,       // pressure 0: passes freely; what comes in carries nothing
  };
  Kind kind = Kind::free_slip;
  Vec3 velocity = Vec3::Zero();  // of no_slip [m/s]
  // The velocity times 16 s^2 (1-s)^2 over the side, s along the velocity: a lid without jumps in the corners.
  bool regularized = false;
  double density = 0, temperature = 0;  // of what comes in
  int of = 0;                           // which density: 0 the first, k the k-th of FlowProblem::densities
};
std::string side_name(Side::Kind);

// Initial velocity. An aperiodic velocity is made divergence-free by the solver's first projection.
struct AtRest {};
struct TaylorGreen {  // u = speed sin kx cos ky, v = -speed cos kx sin ky, k = 2 pi waves / size, from the low corner
  double speed = 1;   // [m/s]
  int waves = 1;
};
struct Swirl {       // a vortex in the box that is 0 at its walls: psi = speed size / pi sin^2(pi x) sin^2(pi y)
  double speed = 1;  // [m/s]
};
struct RigidRotation {
  Point3 center = Point3::Zero();
  Vec3 rate = Vec3::UnitZ();  // [1/s]
};
struct Wind {                                         // velocity + gust sin(2 pi frequency t)
  Vec3 velocity = Vec3::Zero(), gust = Vec3::Zero();  // [m/s]
  double frequency = 0;                               // [Hz]
  Vec3 at(double time) const { return velocity + std::sin(2 * pi * frequency * time) * gust; }
};
using StartVelocity = std::variant<AtRest, TaylorGreen, Swirl, RigidRotation, Wind>;
Vec3 velocity_at(const StartVelocity&, const Box&, const Point3&);  // at first

// amount * exp(-|x - center|^2 / width^2), as Gaussians of media.
struct Blob {
  Point3 center = Point3::Zero();
  double width = 1;                     // [m]
  double density = 0, temperature = 0;  // [-], [K]
};

// amount * cos(2 pi waves . (x - low corner) / size + phase) + offset, of the density.
struct Wave {
  Vec3 waves = Vec3::Zero();  // of each axis, whole numbers
  double density = 0, offset = 0, phase = 0;
};

// Without the offset.
double wave_at(const Wave&, const Box&, const Point3&);

// A further density, beside the first: carried by the same velocity, a medium of its own.
struct NamedDensity {
  std::string name;
  double density = 0;  // at first, everywhere
  std::vector<Blob> blobs;
  std::optional<Wave> wave;
  std::shared_ptr<const VoxelGrid> grid;  // added to what is above
};

struct Source {
  Region region;
  Interval time{0, infinity};                     // [s]
  double density_rate = 0, temperature_rate = 0;  // [1/s], [K/s]: added
  std::optional<double> density, temperature;     // held at
  std::optional<Vec3> velocity;                   // held at [m/s]
  int of = 0;                                     // which density, as for a Side
};

struct Push {  // an acceleration in time
  Region region;
  Interval time{0, infinity};        // [s]
  Vec3 acceleration = Vec3::Zero();  // [m/s^2]
  double frequency = 0;              // [Hz]: times cos(2 pi frequency t)
};

// Particles that the flow carries.
struct ParticleSet {
  enum class Leaving {
    stay,     // at the wall
    wrap,     // comes back on the other side, at the same place of it
    respawn,  // comes back on the other side, at a random place of it
  };
  int count = 1;
  Region region;  // where they begin, the box where it has no end
  std::uint32_t seed = 0;
  Vec3 fall = Vec3::Zero();  // against the air [m/s]
  Leaving leaving = Leaving::stay;
};

struct FlowProblem {
  std::string name;
  std::string file;                          // that it was read from, for messages; empty where it was not
  int dimensions = 3;                        // 2: the flow lies in the plane z = 0, and so does the box
  Box box{Point3::Zero(), Point3::Ones()};   // [m]
  std::array<std::array<Side, 2>, 3> sides;  // [axis][low, high]
  double viscosity = 0;                      // [m^2/s]
  double diffusivity = 0;                    // of density and temperature [m^2/s]
  double decay = 0;                          // of density and temperature [1/s]
  Vec3 gravity = Vec3::Zero();               // [m/s^2]
  double weight = 0;                         // by which share a density of 1 makes the fluid heavier [-]
  double expansion = 0;                      // by which share a kelvin makes it lighter [1/K]
  double confinement = 0;                    // epsilon of vorticity confinement [-]
  StartVelocity velocity = AtRest{};
  bool velocity_stays = false;          // the flow is given: what it carries alone moves
  double density = 0, temperature = 0;  // at first, everywhere
  std::vector<Blob> blobs;
  std::optional<Wave> wave;
  std::vector<NamedDensity> densities;                              // beside the first, which the members above begin
  std::shared_ptr<const VoxelGrid> density_grid, temperature_grid;  // added to what is above
  std::shared_ptr<const VelocityGrid> velocity_grid;
  std::vector<Source> sources;
  std::vector<Surface> obstacles;  // closed: spheres and meshes, standing still
  std::vector<Push> pushes;
  std::vector<ParticleSet> particles;
  double duration = 1;     // [s]
  double frame_rate = 24;  // [1/s]
  std::string hash;        // 32 hex digits of the content: equal hash, equal flow
};

// Reads a file that begins with [flow] (scene/README.md). Throws Error: file, line, column, what was found, what was
// expected.
FlowProblem load_flow(const std::string& path, const Overrides& = {});
FlowProblem parse_flow(const std::string& text, const std::string& name, const std::string& folder,
                       const Overrides& = {});

// The hash of its values; its name, and how they are written, do not count.
std::string content_hash(const FlowProblem&);

// This problem with a single density, stored as the first one: `which` = 0 keeps the first, k the k-th of `densities`.
FlowProblem with_density(const FlowProblem&, int which);
// "density" for the first, else the name.
std::string density_name(const FlowProblem&, int which);

// At the beginning, without what obstacles take away.
Vec3 start_velocity(const FlowProblem&, const Point3&);
double start_velocity(const FlowProblem&, int axis, const Point3&);
double start_density(const FlowProblem&, const Point3&);
double start_temperature(const FlowProblem&, const Point3&);

}  // namespace airlight::scene
