// Settings of the renderer, and what it cannot do.
#pragma once
#include "methods/compensated_ray_marching/compensated_march.h"
#include "methods/compensated_ray_marching/diffusion_system.h"
#include "methods/compensated_ray_marching/residual_store.h"
#include "methods/compensated_ray_marching/source_radiance.h"
#include "scene/base/settings.h"
#include "scene/scene.h"

namespace airlight::compensated_ray_marching {

struct Options {
  // Where source radiance is known: at the centres of the Gaussians, as in the publication; at the nodes of a grid.
  enum class Variant { grid, paper } variant = Variant::grid;
  int order = 4;  // bands of source radiance
  int slices = 256;
  SliceWeight weight = SliceWeight::exact;
  bool residual = true;
  double tolerance = 2e-4;
  int iterations = 200;
  struct Grid {
    enum class Multiple { ordinates, p1, none } multiple = Multiple::ordinates;
    int levels = 8;  // of directions that light is gathered from, and bands of the environment
    int cells = 32;
    double deepest_cell = 1.5;
    int ordinate_levels = 2;
    int azimuths = 8;
  } grid;
  struct Paper {
    enum class Multiple { as_printed, corrected, none } multiple = Multiple::as_printed;
    Transmittance transmittance = Transmittance::paper_squared;
    LeastSquaresSolver solver = LeastSquaresSolver::cg;
    ResidualStore store = ResidualStore::automatic;
    int mesh_spheres = 32;  // that stand for a mesh which casts shadows
  } paper;
};

std::vector<scene::SettingSpec> option_settings();
Options read_options(const scene::Settings&);
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

// Which phase functions are too narrow for the bands that stand for them, in one line; empty: none. `again`: whether multiple scattering is
// kept. The first band left out is (2l+1)/(4 pi) of its moment, g^l of Henyey-Greenstein's: no more than 0.6^4, |g| = 0.6 at order 4.
std::string doubt_of(const scene::Scene&, const Options&, bool again);

}  // namespace airlight::compensated_ray_marching
