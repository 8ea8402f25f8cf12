// Settings of the method.
#pragma once
#include <string>
#include <vector>

#include "methods/wavelet_fog/levels.h"
#include "methods/wavelet_fog/path_table.h"
#include "scene/base/settings.h"
#include "scene/scene.h"

namespace airlight::wavelet_fog {

struct Options {
  // How a ray's optical depth comes about.
  enum class Variant {
    paper,   // approximation and details of any sign, summed, details up to distances (section 4.3)
    tele,    // details up to distances, by one grid at a time
    direct,  // the map itself
    skip,    // the map itself, empty blocks passed at once
    bound,   // per block the coarsest level that keeps the error below the tolerance
    polar,   // integrals from the eye tabulated by angle and distance, once per frame
    pre,     // approximation and bands of wavelets, before deconstruction (section 4.2, eq. 11)
  };
  Variant variant = Variant::skip;
  Coarse coarse = Coarse::wavelet;
  int levels = 3;
  double mu = 0.6;
  double tolerance = 0.03;   // of `bound`, in optical depth
  int angles = 512;          // of `polar`
  double radial_step = 0.5;  // of `polar` [cells]
  double termination = 0;    // transmittance below which a ray ends; 0: never
  int degree = -1;           // of the splines that the maps' pixels are coefficients of; -1: as the scene says
  double keep = 1;           // share of the wavelet coefficients, the greatest, that the map is made of
  double fade = 0;  // [m] the paper's: density falls by e over this vertical distance from the eye; 0: not at all
  int table = 0;    // R of the paper's tables of path integrals, of direct, pre and paper; 0: exact
  PathTable::Lookup lookup = PathTable::Lookup::nearest;
  bool sun = false;       // single scattering of directional lights
  double sun_step = 0.5;  // [cells] between the entries of a sun's map
  int sun_points = 3;     // of a cell; at least its degree + 1
  int shadow_steps = 64;  // shadow rays over the fog on a ray, at least; and sun_points in each cell
};
// Whether a variant reads coarse grids.
bool uses_levels(Options::Variant);
// Whether a variant sums up details of either sign.
bool is_signed(Options::Variant);
// Name of the wavelet family that the method uses for a degree up to 2: haar, cdf22, cdf33. Empty for degree 3.
const char* family_of_degree(int degree);
std::vector<scene::SettingSpec> setting_specs();
Options read_options(const scene::Settings&);
// Why the method cannot render the scene with these settings, a line each; empty: it can.
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

}  // namespace airlight::wavelet_fog
