// A fogmap while it is drawn: the paper's drawing tool (Giroud and Biri 2010, Figure 3) as operations on coefficients.
//
// Deterministic: the same operations give the same bits on any machine. Places are in metres of the map, from its corner.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/media/medium.h"

namespace airlight::wavelet_fog::authoring {

struct MapPlace {
  double x, z;  // [m] from the corner of pixel (0, 0)
};

class Canvas {
 public:
  // Without fog. width, height in pixels of `cell` metres, at least 1 of each.
  Canvas(int width, int height, double cell);

  int width() const { return width_; }
  int height() const { return height_; }
  double cell() const { return cell_; }
  const std::vector<double>& values() const { return values_; }  // x fastest

  struct Brush {
    double radius;        // [m], > 0
    double hardness = 0;  // share of the radius with the full effect; a smooth fall (3 t^2 - 2 t^3) to the rim
    double opacity = 1;   // in [0, 1]
    double value = 1;     // >= 0, of what is painted
    enum class Mode { add, paint, erase } mode = Mode::add;
  };
  // One stroke along the places, at least one: every pixel takes the effect of its distance from the line once. add: value
  // opacity more; paint: towards the value; erase: towards 0.
  void stroke(const std::vector<MapPlace>&, const Brush&);

  struct Noise {
    std::uint32_t seed = 0;
    double size;               // [m] of the largest features, > 0
    int octaves = 4;           // each half as large as the one before, from 1 on
    double gain = 0.5;         // amplitude of each, relative to the one before
    double low = 0, high = 1;  // values are scaled to this range, and cut at 0
    enum class Mode { add, multiply } mode = Mode::add;
  };
  // Gradient noise (Perlin 2002) in octaves.
  void noise(const Noise&);

  // By a Gaussian of this standard deviation [m]; mirrored at the rim, so that the sum stays.
  void blur(double deviation);

  // Adds the columns of a medium over each pixel [m], averaged over `samples`^2 upright rays per pixel, divided by `height`
  // [m]. The canvas's corner lies at x0, z0.
  void columns(const scene::DensityField&, double x0, double z0, int samples, double height);

 private:
  int width_, height_;
  double cell_;
  std::vector<double> values_;
};

}  // namespace airlight::wavelet_fog::authoring
