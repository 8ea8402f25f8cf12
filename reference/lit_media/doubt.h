// Where samples along camera rays are too coarse for what lies between them: said with the picture.
//
// A step of length h whose middle passes a lamp at the distance d counts (h/d) / (2 atan(h/2d)) times the lamp's light: a quarter too much
// at h = 2 d. A step of optical depth y, lit from the side of its far end, counts (y/2) / sinh(y/2) of it: a quarter too little at y = 2.4.
#pragma once
#include <functional>

#include "reference/lit_media/lit_media.h"

namespace airlight::lit_media {

constexpr double lamp_widths = 2, deepest_step = 2.4;  // each is off by a quarter
constexpr double share_of_rays = 0.01;                 // fewer coarse rays are not worth a line

// Ends of a ray's steps [m], ascending, none where it is not sampled. `t_end`: where the ray ends.
using StepEnds = std::function<void(const Ray&, double t_end, std::vector<double>& ends)>;

// One line, or empty, from at most 16 x 16 rays of the view.
std::string doubt_of_steps(const LitMedia&, const scene::Scene&, const scene::View&, const StepEnds&);

}  // namespace airlight::lit_media
