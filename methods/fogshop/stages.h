// Decides which stages of the method a scene needs.
#pragma once
#include "methods/fogshop/model.h"

namespace airlight::fogshop {

struct Needs {
  bool distances;              // d_vp of every pixel
  bool center_depths;          // T(s,b_i), T(v,b_i), T(s,v)
  bool light_maps;             // T(s,.) around every light
  bool f_table;                // the paper's table of F
  bool airlight;               // there is a medium
  bool surfaces;               // something to light
  bool low_resolution;         // airlight for some pixels only, and upsampling
  bool scattered;              // light that the medium scatters onto surfaces
  bool point_harmonics;        // light of point lights in harmonics of the NPSF
  bool reflectances;           // B_pv in harmonics
  bool environment;            // an environment light that reaches the scene: the background
  bool environment_harmonics;  // its projection
  bool environment_airlight;   // light of the environment in the air
  bool depth_tree;             // average depths on surfaces
  bool environment_psf;        // the point spread functions of Eqs. 27 and 28
  bool transfer;               // surfaces that shadow scattered light and environments
  bool sky_volume;             // the grid instead of Eq. 28

  bool operator==(const Needs&) const = default;
};

struct Plan {
  Needs needs;
  std::vector<scene::Stage> stages;  // every one, kept or left out, with the reason
  std::string doubt;                 // doubt_of the scene
};
Plan make_plan(const scene::Scene&, const Model&);

// Why the scene cannot be seen from this camera; empty if it can.
std::string unsupported_view(const scene::Scene&, const Fog&, const Options&, const scene::Camera&);

}  // namespace airlight::fogshop
