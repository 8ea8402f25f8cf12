// Error bounds for pictures whose samples brought no light: the error is 0 only if no light can come there at all.
#pragma once
#include "reference/path_tracer/world.h"
#include "scene/renderer.h"

namespace airlight::path_tracer {

// For each channel: can any path from the eye along the ray end on a light? False where all lights are black or absent,
// or the ray meets nothing that scatters or reflects and sees no environment. True does not mean that light comes.
std::array<bool, 3> may_shine(const World&, const Ray&);
// May any ray of a pixel end on a light? Tests its centre, or a 4 x 4 pattern where the pixel is a mean.
std::array<bool, 3> may_shine(const World&, const scene::View&, int x, int y);

// Standard error of the mean of n samples of these sums. Where so few of them contributed that their scatter proves
// nothing (fewer than 4, or all the light came from fewer than 4) it is an upper end instead, in place of 0 or below:
// contributions that 0 of n samples met come to at most 3 in n (95 %: (1 - 3/n)^n = 0.05), and are taken to be as large
// as the greatest sample of the picture.
double honest_error(double sum, double square, double n, double greatest_of_picture, bool may_shine);

}  // namespace airlight::path_tracer
