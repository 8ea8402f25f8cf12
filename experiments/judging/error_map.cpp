#include "experiments/judging/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

// Viridis (Smith and van der Walt 2015) at equal distances, 8-bit sRGB.
constexpr std::array<std::array<int, 3>, 9> viridis{{{68, 1, 84},
                                                     {71, 44, 122},
                                                     {59, 81, 139},
                                                     {44, 113, 142},
                                                     {33, 144, 141},
                                                     {39, 173, 129},
                                                     {92, 200, 99},
                                                     {170, 220, 50},
                                                     {253, 231, 37}}};

double linear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

Rgb colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * double(viridis.size() - 1);
  const std::size_t i = std::min(std::size_t(at), viridis.size() - 2);
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c)
    out[long(c)] = linear(std::lerp(viridis[i][c], viridis[i + 1][c], at - double(i)) / 255);
  return out;
}

}  // namespace

scene::Film error_map(const scene::Film& image, const scene::Film& reference, const std::string& layer, double top,
                      int shrink) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(fmt::format("the image is {}x{}, and the reference {}x{}", image.width, image.height, reference.width,
                            reference.height));
  if (image.width % shrink != 0 || image.height % shrink != 0)
    throw Error(fmt::format("--map-shrink {}: expected a number that divides the film's size {}x{}", shrink,
                            image.width, image.height));
  image.layer(layer);  // throws where it is missing
  double mean = 0;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) mean += luminance(reference.get(layer, x, y));
  mean /= double(reference.pixels());
  scene::Film map(reference.width / shrink, reference.height / shrink);
  map.add("mean");
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      double error = 0;
      for (int j = y * shrink; j < (y + 1) * shrink; ++j)
        for (int i = x * shrink; i < (x + 1) * shrink; ++i)
          error += std::abs(luminance(image.get(layer, i, j) - reference.get(layer, i, j))) / (shrink * shrink);
      map.set("mean", x, y, colour(error == 0 ? 0 : error / (mean * top)));
    }
  return map;
}

}  // namespace airlight::experiments
