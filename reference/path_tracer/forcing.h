// How the collision on a segment of a path is drawn: by one analog flight, or forced, however thin the medium is.
//
// A forced flight is one on which tracking meets at least one collision, null ones counted: the first lies at a
// majorant depth drawn from the exponential cut off at the segment's whole one, after which tracking goes on as always.
// That takes no transmittance; it is exact for any majorant, and draws the distances of a homogeneous medium without
// rejection. Where all that it met were null collisions, it is tried again, a few times; on a thin segment until misses
// are of no account, or a few times where they are common all the same. The end of the segment is then not what is left
// over when nothing collided, but reached for certain, with the exact transmittance.
#pragma once
#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/media.h"
#include "scene/scene.h"

namespace airlight::path_tracer {

struct Flight {
  bool forced = false;
  int tries = 1;
  Rgb flight_probability =
      Rgb::Ones();                  // of trying at all, in [0, 1], where the path follows this channel's extinction
  Rgb any_tentative = Rgb::Ones();  // probability of a collision, null ones counted, which is given where it is below 1
  Rgb gain = Rgb::Ones();  // how much denser collisions are on the segment than an analog flight's, per channel
  Rgb transmittance = Rgb::Ones();  // of the whole segment; known where forced
};

// The flight on [0, tmax] of a ray that meets a medium, tried with the probability boost * (1 - transmittance), at most
// 1; boost >= 1, infinity: always.
Flight force(const Media&, const Ray&, double tmax, double boost, Counters&);

// Factor on the probability of collisions in a scene so thin that hardly any path would have one. With it the relative
// error at a number of samples does not depend on the extinction. 1 for media that are not that thin. The thickness is
// the greatest optical depth through the middle of the media, over at most the size of the scene's content.
double collision_boost(const scene::Scene&);

}  // namespace airlight::path_tracer
