// Are two images equal but for noise? Three tests on blocks of 8x8 pixels, and what they could have missed.
//
// Each block and channel gives t = (mean A - mean B) / standard error, from the scatter of the sixteen batches of
// whichever image is noisy (Welch's degrees of freedom), turned into the normal value z of the same probability. Tests,
// each at a third of alpha: the largest |z| against Sidak's threshold; the sum of z^2 against chi-square, both tails
// (channels share samples, so each channel by itself, at a third again); z of the whole image. Where an image knows of
// more than its batches show (batches.h) the variance is an upper end: such blocks may well be too alike, and the lower
// tail is that of the others.
#pragma once
#include <string>
#include <vector>

#include "scene/film/film.h"

namespace airlight::experiments {

struct Equality {
  std::size_t blocks = 0;     // blocks times channels that have noise
  std::size_t differing = 0;  // blocks without noise that differ: any such is a difference
  double largest_z = 0;
  double largest_threshold = 0;
  double chi_square = 0;  // of the channel with the smallest probability
  double chi_square_probability = 1;
  bool too_alike = false;  // chi-square objects, and by its lower tail: the blocks scatter less than their noise
  double image_z = 0;
  double image_threshold = 0;
  double detectable_bias = 0;  // smallest relative bias found with probability 0.95, of the whole image; NaN: no noise
  double block_skewness = 0;   // of the mean over a block, pooled over a channel: the largest of the three
  double image_skewness = 0;   // of the mean over the image: the same
  bool blocks_in_range = true;
  bool image_in_range = true;
  bool equal = false;   // no test objects
  bool tested = false;  // all in range, and detectable_bias <= 1 %: an `equal` without it means little
};

inline constexpr double most_skewness = 0.1;

// Throws Error if sizes differ, a value is not finite, neither image is noisy, or every pixel is left out. The images
// must not share random numbers.
Equality compare_equal(const scene::Film& a, const scene::Film& b, const std::string& layer,
                       const std::vector<unsigned char>& left_out, double alpha);

// How many of the three tests object at this alpha. A block that differs without noise counts with the first test.
int objections(const Equality&, double alpha);

// The number of objections by tests whose means are in range.
int sure_objections(const Equality&, double alpha);

// One line for people.
std::string text(const Equality&);

}  // namespace airlight::experiments
