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
};
Needs needs_of(const scene::Scene&, const Model&);

// Every stage, kept or left out, with the reason.
std::vector<scene::Stage> describe_stages(const scene::Scene&, const Model&);

inline constexpr char needs_view_point[] =
    "variant paper needs a perspective camera: its depths T(v, b_i) start from one view point";

}  // namespace airlight::fogshop
