// Light of the environment inside the Gaussians, on a grid: what a point of the medium would scatter if everything that
// reaches it unscattered were, not in the paper.
//
// Eq. 28 of Zhou et al. 2007 takes one depth, that of the view ray, for the way in and the way out, and is dark where a
// cloud is thick. Here the way in has depths of its own: J(x) = 1/(4 pi) integral L(w) e^-T(x,w) dw at the nodes of a
// grid, where surfaces stand in the way of L, and trilinear between them. A ray adds up J (e^-T_k - e^-T_k+1) over slices
// with exact depths T_k. One grid serves all rays, and those that end at a surface too.
#pragma once
#include <cstdint>
#include <vector>

#include "methods/fogshop/fog.h"
#include "methods/fogshop/kernels.h"
#include "scene/renderer.h"

namespace airlight::fogshop {

// Light that arrives from one direction.
struct SkyBeam {
  Vec3 direction;  // towards the light, unit
  Rgb weight;      // radiance times solid angle over 4 pi [W/m^2/sr]
};
// `directions` of each environment light, chosen by its radiance, evenly spread.
std::vector<SkyBeam> sky_beams(const scene::Scene&, int directions);

// Cubes around the Gaussians' spheres, `cells` of them along the longest side. Requires a Gaussian.
struct SkyGrid {
  SkyGrid(const GaussianArrays&, int cells);

  Point3 corner;
  double cell;          // [m]
  Eigen::Array3i last;  // greatest node index per axis, >= 1

  std::size_t nodes() const { return std::size_t((last + 1).cast<double>().prod()); }  // x fastest
  Point3 node(std::size_t) const;
};

// Which beams surfaces let through to the nodes of a grid. Nodes that none reaches, inside or below surfaces, count as the
// nearest that has one: between them and nodes outside values are interpolated.
struct OpenBeams {
  OpenBeams(const scene::Geometry&, const SkyGrid&, const std::vector<SkyBeam>&, const scene::Execution&);

  bool open(std::size_t node, std::size_t beam) const { return bits[node * words + beam / 32] >> beam % 32 & 1; }

  std::size_t words;                // of a node
  std::vector<std::uint32_t> bits;  // [node][beam / 32]
  double rays = 0;
};

class SkyVolume {
 public:
  // A SkyGrid of `cells`; `directions` per environment light, the same at every node. Requires a Gaussian. The fog's
  // constant is not in the depths.
  SkyVolume(const scene::Scene&, const Fog&, const GaussianArrays&, Erf, int cells, int directions,
            const scene::Execution&);

  // J [W/m^2/sr] per channel; beyond the box that of its nearest point.
  Rgb at(const Point3& x) const;

  double evaluations() const { return evaluations_; }  // of the error function
  double shadow_rays() const { return shadow_rays_; }
  std::size_t nodes() const { return values_.size(); }

 private:
  SkyGrid grid_;
  std::vector<Rgb> values_;  // x fastest
  double evaluations_ = 0, shadow_rays_ = 0;
};

}  // namespace airlight::fogshop
