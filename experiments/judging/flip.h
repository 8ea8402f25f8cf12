// HDR-FLIP: how much two pictures seem to differ when one looks at them in turn on a display, from 0 to 1. A metric of display: it says
// nothing of radiance, and nothing of noise. Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020: FLIP: A Difference
// Evaluator for Alternating Images (equations in flip.cpp); Andersson, Nilsson, Shirley, Akenine-Moller 2021: Visualizing Errors in
// Rendered High Dynamic Range Images.
#pragma once
#include <span>
#include <vector>

namespace airlight::experiments {

struct FlipView {
  double pixels_per_degree = 67.0206;  // of 3,840 pixels on 0.7 m, seen from 0.7 m: the papers' own
};

// [stops] Exposures at which the papers compare two pictures: from where the brightest pixel of the reference reaches 0.85 after tone
// mapping to where its median pixel does, at most 1 apart, at least two. Where half of the pixels are black the median is that of the
// others: the papers' rule has no answer there. Empty if all are black.
std::vector<double> flip_exposures(std::span<const float> reference);

// The difference of each pixel, the greatest over these exposures after the ACES tone curve. Both are linear RGB of width * height pixels
// with sRGB's primaries; values below 0 count as 0.
std::vector<double> flip_map(std::span<const float> image, std::span<const float> reference, int width, int height,
                             const FlipView& = {});

// The mean of a map.
double flip(std::span<const float> image, std::span<const float> reference, int width, int height);

}  // namespace airlight::experiments
