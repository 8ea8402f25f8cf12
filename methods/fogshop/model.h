// State of the method before rendering: settings, medium, lights, and the tables of `prepare`.
#pragma once
#include <memory>
#include <vector>

#include "methods/fogshop/environment_psf.h"
#include "methods/fogshop/f_table.h"
#include "methods/fogshop/fog.h"
#include "methods/fogshop/kernels.h"
#include "methods/fogshop/light_map.h"
#include "methods/fogshop/noise.h"
#include "methods/fogshop/sky_volume.h"
#include "scene/renderer.h"

namespace airlight::fogshop {

struct Options {
  enum class Variant { paper, slices };
  Variant variant = Variant::slices;
  int slices = 24;          // K
  bool extrapolate = true;  // from K/2 and K slices; K is even
  bool boxes = true;        // edge placement S3
  bool map = true;          // depths from the light by its map, else by exact sums
  int map_directions = 64;  // R
  int map_edges = 48;       // N
  bool table = false;       // F from the paper's table
  Erf erf = Erf::precise;
  Cull cull = Cull::depth;
  double depth_threshold = 1e-4;  // eps_T
  double source_radius = 0;       // [m]
  // Light that the medium scatters onto surfaces: not at all, by the printed NPSF, by that of the depth at hand, or
  // without harmonics.
  enum class Reflectance { direct, npsf, npsf_by_depth, sun };
  Reflectance reflectance = Reflectance::direct;
  int sh_order = 6;                 // bands of the NPSF and of the environment
  Psf environment_psf = Psf::ball;  // what spreads light of an environment
  // Airlight of the environment: Eq. 28 where no surface ends the ray, or everywhere; or by SkyVolume.
  enum class EnvironmentAirlight { psf, everywhere, volume };
  EnvironmentAirlight environment_airlight = EnvironmentAirlight::psf;
  bool everywhere() const { return environment_airlight == EnvironmentAirlight::everywhere; }
  bool sky_volume() const { return environment_airlight == EnvironmentAirlight::volume; }
  int sky_cells = 24;
  int sky_directions = 64;
  bool depth_tree = true;                  // Eq. 26 by a DepthTree
  double environment_distance = infinity;  // D [m]: view rays that nothing ends, and Eq. 26, reach so far
  // Airlight for one pixel in downsample^2; how the others get theirs.
  enum class Upsample { bilinear, paper, recompute };
  int downsample = 1;
  Upsample upsample = Upsample::recompute;
  // Rays bent by noise, section 5.5; 0: none.
  double noise_scale = 0, noise_frequency = 1, noise_phase = 0;
  std::uint32_t noise_seed = 0;
  bool prt = false;          // meshes: surfaces shadow the scattered light
  int prt_rays = 256;        // per vertex
  double prt_reach = 1e300;  // [m] of occluders
  int prt_bounces = 0;       // of light between the surfaces
};
std::vector<scene::SettingSpec> setting_specs();
Options read_options(const scene::Settings&);

struct LightModel {
  Point3 position;
  Rgb intensity;  // [W/sr]
  std::vector<double>
      center_depth;  // paper: T(s,b_i) - T_i(s,b_i) by place, the constant included [-], at extinction ratio 1
  std::shared_ptr<const LightMap> map;  // slices, if asked for
};

struct Model {
  Options options;
  Fog fog;
  GaussianArrays gaussians;
  int dropped = 0;                 // Gaussians that nothing would see
  double threshold = 0;            // CulledGaussians::threshold
  std::vector<LightModel> lights;  // the point lights that shine
  bool scatters = true;            // false: the media scatter nothing of any
  bool environment = false;        // an environment light shines
  // Variant S: what the Gaussians take of a point light on any way, at most, if it is too little to be looked at: less than
  // a tenth of eps_T. Their depths from lights are then 0.
  double taken = 0;
  bool clear_ways = false;
  std::shared_ptr<const FTable> f_table;
  std::unique_ptr<Noise> noise;          // null: none
  std::shared_ptr<const SkyVolume> sky;  // null: left out
  double evaluations = 0;                // of the error function, what was kept of a frame before left out
  double map_error = 0;                  // of light maps, estimated; where it is too great options.map is false

  int scattered_lights() const { return scatters ? int(lights.size()) : 0; }
  bool paper() const { return options.variant == Options::Variant::paper; }
};

// Everything but the tables.
Model make_model(const scene::Scene&, const Options&);

// T(from, b_i) - T_i(from, b_i) for every Gaussian, the constant included [-], at extinction ratio 1: n rays against n Gaussians, each
// cut off at its radius. Adds to `evaluations`.
std::vector<double> depths_to_centers(const Model&, const Point3& from, const scene::Execution&, double& evaluations);

// The Gaussians' optical depth between two points [-], at extinction ratio 1, without the constant.
double gaussian_depth(const Model&, const Point3& a, const Point3& b, Crossings&, double& evaluations);

}  // namespace airlight::fogshop
