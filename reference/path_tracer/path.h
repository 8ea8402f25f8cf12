// One random walk from the eye: which estimators are summed along it.
//
// Collisions by delta tracking. At every vertex one light is sampled (next-event estimation); the environment is
// combined with the continuation of the walk, and a point light that is close to a medium with a "connection": a
// second ray from the vertex, towards the light more often than not, on which a point is drawn with equal angles as the
// light sees them. Combinations weight by the balance heuristic: connections with the true densities, transmittances
// included; the environment with those of the directions alone, which saves an optical depth for every walk that leaves
// and costs next to no variance (1 % on thin smoke).
//
// Where collisions are rare they are forced, and paths split before surfaces: forcing.h.
//
// Coloured extinction: the walk follows the extinction of one channel, drawn uniformly; every channel is weighted by
// the mean of the densities with which the three would have made the path (spectral multiple importance sampling,
// balance heuristic; Wilkie et al. 2014).
#pragma once
#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/path_sample.h"
#include "reference/path_tracer/world.h"

namespace airlight::path_tracer {

// The radiance of one path along the ray.
void trace(const World&, const CameraRay&, const SampleRandom&, PathSample&, Counters&);

}  // namespace airlight::path_tracer
