// How many samples a picture gets: a fixed number, or, tile by tile, until an error is reached.
#pragma once
#include "reference/path_tracer/accumulation.h"

namespace airlight::path_tracer {

// Renders options().samples per pixel. With a target error it looks at n = 64, 128, 256, ... and stops a tile where
//   standard error of its mean / max(its mean, 1e-3 of the film's mean) < target   and
//   greatest sample / (n mean) < 0.05,
// the luminance of both, at the latest at options().samples. Such stopping has a slight bias: published references use
// a fixed number, found from a pilot of another stream. Returns false if it was interrupted; what is done is kept.
bool render_to_target(const World&, const scene::View&, const scene::Execution&, Accumulation&);

}  // namespace airlight::path_tracer
