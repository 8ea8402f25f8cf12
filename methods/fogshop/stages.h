// What a scene needs of the method, and what it does not.
#pragma once
#include "methods/fogshop/model.h"

namespace airlight::fogshop {

struct Needs {
  bool distances;      // d_vp of every pixel
  bool center_depths;  // T(s,b_i), T(v,b_i), T(s,v)
  bool light_maps;     // T(s,.) around every light
  bool f_table;        // the paper's table of F
  bool airlight;       // there is a medium
  bool surfaces;       // something to light
  bool scattered;      // light that the medium scatters onto surfaces
  bool transfer;       // surfaces that shadow it
};
Needs needs_of(const scene::Scene&, const Model&);

// Every stage, kept or left out, with the reason.
std::vector<scene::Stage> describe_stages(const scene::Scene&, const Model&);

// Why the scene cannot be seen from this camera; empty if it can.
std::string objection_to_view(const scene::Scene&, const Fog&, const Options&, const scene::Camera&);

}  // namespace airlight::fogshop
