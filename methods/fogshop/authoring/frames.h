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

// The two frames around `frame`, or the one that it is, of a sequence as `airlight fit` writes it: a table of Gaussians with
// ids for each frame, in a file whose name has the digits of its number where `path` has #, leading zeros included. Throws
// Error: no such table, `frame` before the first or after the last, a table without ids, an id twice, an amplitude below 0.
Frames read_frames_around(const std::string& path, double frame);

// Equal ids of the two frames around `frame` are interpolated linearly in position, radius and density; the density of a
// particle that only the earlier frame has falls to 0, of one that only the later has rises from 0, where it is there. Throws
// Error before the first frame and after the last.
Frame interpolate(const Frames&, double frame);

}  // namespace airlight::fogshop::authoring
