// The last picture's marched film, blended into this one where its rays were in that: reprojection, as engines do while the camera moves.
#pragma once
#include "reference/half_resolution_march/passes.h"

namespace airlight::half_resolution_march {

struct History {
  LowFilm film;  // before the blur
  scene::View view;

  // Films of two sizes have nothing to do with each other.
  bool fits(const scene::View& now) const { return now.width == view.width && now.height == view.height; }
};

// Where the ray of block (x, y), which meets media, was in the last view: `distance` along it is the point that is looked for [m], `t_end`
// where it ends. The blocks' middles move as the point does, so that a camera at rest finds every block where it was, whichever of its
// pixels is marched.
Trace trace_of(const LowFilm&, int x, int y, const Ray&, double distance, double t_end, const scene::View&,
               const scene::View& last);

// film += history_weight (history - film). The history is bilinear between four blocks, of which those are left out whose depth differs by
// more than `edge` [m] from what ends the ray (Schied et al. 2017, section 4.1); where less than 1 % of the weights is left there is none.
// With `clamp` it is limited, by channel, to the range of the 3 x 3 new marched pixels (Karis 2014).
void blend(const Options&, const History&, const std::vector<Trace>&, double edge, LowFilm&, const scene::Execution&,
           Counters&);

}  // namespace airlight::half_resolution_march
