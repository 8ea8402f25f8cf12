// The named metrics (and no others): errors of an image against a reference, corrected for the noise of both.
//
//   rmse            sqrt of the mean squared error
//   rel_l2          sqrt(MSE / mean R^2), and rel_l2_squared
//   rmse_range      rmse / (max R - min R), R smoothed over 3x3 pixels
//   rel_mse         mean of d^2 / (R^2 + 0.01 mean(R)^2); numerator and denominator from different halves of the
//                   samples, and what noise in the denominator adds taken out by the jackknife (without it 3.5 % at a
//                   noise of 8 %)
//   bias            sum A / sum R - 1, signed
//   p95, p99, p999  95th, 99th and 99.9th percentile of |d| / (R + 0.01 max R)
//   wrong           share of pixels where |d| > 1e-4 mean(R) in some channel; not defined with noise
//
//   flip            HDR-FLIP (flip.h), the mean over all pixels: 0 to 1, a metric of display, not for gates of accuracy. Noise is
//                   seen as it is; the interval is what noise as large as the reference's changes
//
//   objections       of the three tests of equality (equality.h, false alarms 1e-4 together), how many object: 0 if the
//                    images are equal but for noise; not defined without noise. Where samples are too skewed for the
//                    tests (fireflies), the lower end of its interval is what objects all the same
//   largest_z        the largest |z| of a block of 8x8 pixels
//   detectable_bias  smallest relative bias of the whole image that those tests find with probability 0.95; not defined
//                    where samples are too skewed for the test of the whole image
//
// Prefix "converted.", before any other: against the picture of the media as they were converted for the method (key `convert`), which is what
// the method itself adds. Without it: against the picture of the scene.
// Prefix "foreground." : only pixels where 1 - transmittance > 1e-3 in some channel. Suffix ".r", ".g", ".b": one
// channel; else all channels together. FLIP and tests of equality take neither. Pixels that touch a light's ball are left out of
// all of them.
//
// With noise, squares are means over pairs of different batches, (A - R_p)(A - R_q), so that no noise is squared, and
// intervals are delete-one jackknives over the batches. Percentiles cannot be corrected that way: their interval is the
// one that the noise (half the difference of two halves) leaves possible.
//
// Where the image's noise is counted, it is part of the squares and percentiles. Their intervals, and that of `bias`,
// still cover what other random numbers would give: from its batches, or from its standard errors where it has too few
// samples for batches (pixels independent, channels of a pixel not).
#pragma once
#include <string>
#include <vector>

#include "scene/film/film.h"

namespace airlight::experiments {

struct Measure {
  std::string name;
  double value = 0;  // NaN where the metric is not defined (a black reference, an empty mask)
  double low = 0;    // 95 % interval; equal to `value` where both images are exact
  double high = 0;
  double floor = 0;          // the noise in the metric's unit; 0 if exact
  bool below_floor = false;  // the interval reaches 0: nothing is known but |error| <= high
};

// "0.0123", "0.0123 [0.0119, 0.0127]" or "below noise floor, <= 0.0021".
std::string text(const Measure&);

// Pixels; empty: none left out, or foreground not known.
struct Masks {
  std::vector<unsigned char> left_out;
  std::vector<unsigned char> foreground;
};

// Pixels whose `transmittance` layer is below 1 - 1e-3 in some channel; empty if the film has no such layer.
std::vector<unsigned char> foreground_mask(const scene::Film&);

enum class ImageNoise {
  removed,  // the error is that of the image with infinitely many samples
  counted,  // the error is that of an image with as many samples
};

// All names without prefix and suffix.
const std::vector<std::string>& metric_names();

// Has the name the prefix "converted."?
bool is_of_converted(const std::string& name);

// Throws Error with the nearest valid name; `where` begins the message.
void check_metric_name(const std::string& name, const std::string& where);

// Throws Error for different sizes, values that are not finite, a foreground metric without a foreground, and images
// whose noise is not known (`removed`: no batches; `counted`: neither batches nor standard errors of two samples or
// more).
std::vector<Measure> measure(const std::vector<std::string>& names, const scene::Film& image,
                             const scene::Film& reference, const std::string& layer, const Masks&,
                             ImageNoise = ImageNoise::removed);

}  // namespace airlight::experiments
