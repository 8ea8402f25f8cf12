// An animation of radial basis functions made elsewhere, as a table of frames (Zhou et al. 2007, section 6: Pighin et
// al. 2004, or a commercial animation system).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::fogshop::authoring {

struct FrameParticle {
  Point3 position = Point3::Zero();  // [m]
  double radius = 1;                 // [m], > 0: 1 / a
  double density = 1;                // [1/m], >= 0: c
};
using Frame = std::map<long long, FrameParticle>;  // by id
using Frames = std::map<double, Frame>;            // by frame number

// CSV with the header `frame,id,x,y,z,radius,density`, one particle of one frame a line; empty lines and those that
// begin with # are passed over. Throws Error: file:line:column, what was found, what was expected.
Frames read_frames(const std::string& path);

// Equal ids of the two frames around `frame` are interpolated linearly in position, radius and density; a particle that
// only the earlier frame has stays as it is there, one that only the later has is not there yet. Throws Error before
// the first frame and after the last.
Frame interpolate(const Frames&, double frame);

}  // namespace airlight::fogshop::authoring
