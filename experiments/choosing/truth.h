// A quick reference of some pixels of a scene's film, and errors against it.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/choosing/sparse_view.h"
#include "experiments/judging/metrics.h"

namespace airlight::experiments {

struct TrialSetup {
  int film = 64;            // about as many pixels wide is the small film; that of the scene: nothing is extrapolated
  bool all_orders = true;   // of scattering are in the reference; else one
  long long samples = 256;  // of the reference, if it is path-traced
  int stream = 0;           // of its random numbers
  int threads = 0;          // 0: all
  double spend = 60;        // [s] for everything
  double frames_seconds = 0.1;  // [s] for the frames of one candidate on one film
};

// The truth on the small film.
struct Truth {
  SparseView sparse;
  scene::Film film;
  std::vector<unsigned char> left_out;  // pixels that touch a light's ball
  long long samples = 0;                // 0: quadrature
  std::string about;                    // "path tracing of all orders, 256 samples, 64 x 48 of the pixels"
};

// How far a run is, in [0, 1].
using Report = std::function<void(double)>;

// In about `allowed` seconds: with fewer samples than asked for where they take longer, but at least 64. Throws NotSupported, Interrupted,
// and Error where it is black.
Truth trace_truth(const std::shared_ptr<const scene::Scene>&, const TrialSetup&, double allowed, const Report&);

// Relative L2 of the pixels, with the noise of the reference taken out; that of a path-traced picture is counted. The interval has the
// noise in it and, where not every pixel is looked at, what other pixels could give: sixteen interleaved groups of pixels are left out in
// turn (jackknife).
Measure error_of(const scene::Film& pixels, const Truth&, bool count_noise);

}  // namespace airlight::experiments
