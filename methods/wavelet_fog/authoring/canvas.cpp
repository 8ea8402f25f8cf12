#include "methods/wavelet_fog/authoring/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "scene/convert/fogmap_columns.h"
#include "scene/math/elementary.h"
#include "scene/math/random.h"

namespace airlight::wavelet_fog::authoring {
namespace {

double square(double x) { return x * x; }

double distance_to_segment(const MapPlace& p, const MapPlace& a, const MapPlace& b) {
  const double dx = b.x - a.x, dz = b.z - a.z, length = dx * dx + dz * dz;
  const double t = length > 0 ? std::clamp(((p.x - a.x) * dx + (p.z - a.z) * dz) / length, 0.0, 1.0) : 0;
  return std::sqrt(square(p.x - a.x - t * dx) + square(p.z - a.z - t * dz));
}

// The dot product of a lattice point's gradient with the way from it.
double slope(std::uint32_t seed, int octave, int i, int j, double x, double z) {
  const RandomBlock block{
      philox4x32_10({std::uint32_t(i), std::uint32_t(j), std::uint32_t(octave), 0}, {seed, 0x666f67u})};
  return (2 * block.fine(0) - 1) * x + (2 * block.fine(1) - 1) * z;
}

double gradient_noise(std::uint32_t seed, int octave, double x, double z) {
  const double cx = std::floor(x), cz = std::floor(z), fx = x - cx, fz = z - cz;
  const int i = int(cx), j = int(cz);
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const double u = fade(fx);
  return mix(mix(slope(seed, octave, i, j, fx, fz), slope(seed, octave, i + 1, j, fx - 1, fz), u),
             mix(slope(seed, octave, i, j + 1, fx, fz - 1), slope(seed, octave, i + 1, j + 1, fx - 1, fz - 1), u),
             fade(fz));
}

// One row or column, mirrored at its ends.
void blur_line(double* values, int count, std::ptrdiff_t step, const std::vector<double>& kernel,
               std::vector<double>& scratch) {
  const int reach = int(kernel.size()) - 1;
  scratch.assign(count, 0);
  for (int k = 0; k < count; ++k) {
    const double value = values[k * step];
    for (int d = -reach; d <= reach; ++d) {
      int at = (k + d) % (2 * count);
      if (at < 0) at += 2 * count;
      scratch[at < count ? at : 2 * count - 1 - at] += kernel[std::abs(d)] * value;
    }
  }
  for (int k = 0; k < count; ++k) values[k * step] = scratch[k];
}

}  // namespace

Canvas::Canvas(int width, int height, double cell)
    : width_(width), height_(height), cell_(cell), values_(std::size_t(width) * height) {}

void Canvas::stroke(const std::vector<MapPlace>& places, const Brush& brush) {
  for (int j = 0; j < height_; ++j)
    for (int i = 0; i < width_; ++i) {
      const MapPlace middle{(i + 0.5) * cell_, (j + 0.5) * cell_};
      double distance = distance_to_segment(middle, places.front(), places.front());
      for (std::size_t k = 1; k < places.size(); ++k)
        distance = std::min(distance, distance_to_segment(middle, places[k - 1], places[k]));
      if (!(distance < brush.radius)) continue;
      const double hard = brush.hardness * brush.radius;
      const double t = distance <= hard ? 1 : (brush.radius - distance) / (brush.radius - hard);
      const double effect = brush.opacity * t * t * (3 - 2 * t);
      double& value = values_[std::size_t(j) * width_ + i];
      switch (brush.mode) {
        case Brush::Mode::add:
          value += effect * brush.value;
          break;
        case Brush::Mode::paint:
          value += effect * (brush.value - value);
          break;
        case Brush::Mode::erase:
          value *= 1 - effect;
          break;
      }
    }
}

void Canvas::noise(const Noise& n) {
  std::vector<double> field(values_.size());
  for (int j = 0; j < height_; ++j)
    for (int i = 0; i < width_; ++i) {
      double sum = 0, amplitude = 1, scale = cell_ / n.size;
      for (int octave = 0; octave < n.octaves; ++octave, amplitude *= n.gain, scale *= 2)
        sum += amplitude * gradient_noise(n.seed, octave, (i + 0.5) * scale, (j + 0.5) * scale);
      field[std::size_t(j) * width_ + i] = sum;
    }
  const auto [least, most] = std::minmax_element(field.begin(), field.end());
  const double lo = *least, range = *most - *least;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double share = range > 0 ? (field[i] - lo) / range : 0.5;
    const double value = std::max(0.0, n.low + share * (n.high - n.low));
    values_[i] = n.mode == Noise::Mode::add ? values_[i] + value : values_[i] * value;
  }
}

void Canvas::blur(double deviation) {
  const double pixels = deviation / cell_;
  // Its longest wave is twice the map; at this width it falls by exp(-8 pi^2).
  if (pixels >= 4.0 * std::max(width_, height_)) {
    std::fill(values_.begin(), values_.end(),
              std::accumulate(values_.begin(), values_.end(), 0.0) / double(values_.size()));
    return;
  }
  scene::require_time(1e-9 * 2 * 8 * (pixels + 1) * double(values_.size()),
                      fmt::format("a blur of {:g} pixels over {} x {}", pixels, width_, height_));
  std::vector<double> kernel;
  double sum = 0;
  for (int d = 0; d == 0 || d <= 4 * pixels; ++d) {
    kernel.push_back(pixels > 0 ? elementary::exp(-0.5 * square(d / pixels)) : 1);
    sum += d == 0 ? kernel.back() : 2 * kernel.back();
  }
  for (double& k : kernel) k /= sum;
  std::vector<double> scratch;
  for (int j = 0; j < height_; ++j) blur_line(values_.data() + std::size_t(j) * width_, width_, 1, kernel, scratch);
  for (int i = 0; i < width_; ++i) blur_line(values_.data() + i, height_, width_, kernel, scratch);
}

void Canvas::columns(const scene::DensityField& field, double x0, double z0, int samples, double height) {
  const std::vector<double> columns = scene::column_densities(field, {width_, height_, cell_, x0, z0}, samples);
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += columns[i] / height;
}

}  // namespace airlight::wavelet_fog::authoring
