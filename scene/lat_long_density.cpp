#include "scene/lat_long_density.h"

#include <algorithm>
#include <cmath>

#include "scene/math/elementary.h"

namespace airlight::scene {
namespace {

// Cumulates in place: sums[0] = 0, sums[i + 1] = sum of what was in 1..i+1; then as shares of the total, which is
// returned. All zero stays all zero.
double cumulate(double* sums, int count) {
  sums[0] = 0;
  for (int i = 0; i < count; ++i) sums[i + 1] += sums[i];
  const double total = sums[count];
  if (total > 0)
    for (int i = 0; i <= count; ++i) sums[i] /= total;
  return total;
}

// The bin that u falls into, never an empty one; u becomes the position within the bin, in [0, 1].
int choose(const double* shares, int count, double& u) {
  // The last bin that begins at or before u; empty bins begin where the next one does.
  int bin = int(std::upper_bound(shares, shares + count + 1, u) - shares) - 1;
  bin = std::clamp(bin, 0, count - 1);
  while (bin > 0 && !(shares[bin + 1] > shares[bin])) --bin;  // u at the very end
  u = std::clamp((u - shares[bin]) / (shares[bin + 1] - shares[bin]), 0.0, 1.0);
  return bin;
}

// x in [0, 1] with density proportional to a + (b - a) x; the form without cancellation.
double sample_linear(double a, double b, double u) {
  const double denominator = a + std::sqrt(a * a + u * (b - a) * (b + a));
  return denominator > 0 ? std::min(1.0, u * (a + b) / denominator) : u;
}

}  // namespace

LatLongDensity::LatLongDensity(int width, int height, const std::vector<double>& values)
    : width_(width), height_(height) {
  // Scaled so that no square or sum of them overflows or vanishes.
  const double largest = *std::max_element(values.begin(), values.end());
  values_.reserve(values.size());
  for (const double value : values) values_.push_back(largest > 0 ? float(value / largest) : 0.0f);
  cosine_.resize(std::size_t(height) + 2);
  for (int j = 0; j <= height + 1; ++j) cosine_[j] = elementary::sincos_turns(strip_begin(j, height) / (2 * pi)).cos;
  strips_.resize(std::size_t(height) + 2);
  cells_.resize(std::size_t(height + 1) * (width + 1));
  for (int j = 0; j <= height; ++j) {
    const float* top = &values_[std::size_t(std::max(j - 1, 0)) * width];
    const float* bottom = &values_[std::size_t(std::min(j, height - 1)) * width];
    double* cells = &cells_[std::size_t(j) * (width + 1)];
    for (int i = 0; i < width; ++i) {
      const int next = i + 1 == width ? 0 : i + 1;
      cells[i + 1] = 0.25 * ((double(top[i]) + top[next]) + (double(bottom[i]) + bottom[next]));
    }
    strips_[j + 1] = cumulate(cells, width) * (cosine_[j] - cosine_[j + 1]) * 2 * pi / width;
  }
  total_ = cumulate(strips_.data(), height + 1);
}

double LatLongDensity::pdf(const LatLongCell& cell, double direction_y) const {
  const float* top = &values_[std::size_t(cell.top) * width_];
  const float* bottom = &values_[std::size_t(cell.bottom) * width_];
  const auto between = [](double a, double b, double x) { return a + (b - a) * x; };
  const double above = between(top[cell.left], top[cell.right], cell.x);
  const double below = between(bottom[cell.left], bottom[cell.right], cell.x);
  const double y = (cosine_[cell.strip] - direction_y) / (cosine_[cell.strip] - cosine_[cell.strip + 1]);
  return between(above, below, std::clamp(y, 0.0, 1.0)) / total_;
}

Vec3 LatLongDensity::sample(double u1, double u2) const {
  const int strip = choose(strips_.data(), height_ + 1, u1);
  const float* top = &values_[std::size_t(std::max(strip - 1, 0)) * width_];
  const float* bottom = &values_[std::size_t(std::min(strip, height_ - 1)) * width_];
  const int left = choose(&cells_[std::size_t(strip) * (width_ + 1)], width_, u2);
  const int right = left + 1 == width_ ? 0 : left + 1;
  const double a = top[left], b = top[right], c = bottom[left], d = bottom[right];
  const double y = sample_linear(a + b, c + d, u1);
  const double x = sample_linear(a + (c - a) * y, b + (d - b) * y, u2);
  const double height = cosine_[strip] + (cosine_[strip + 1] - cosine_[strip]) * y;
  const double sine = std::sqrt(std::max(0.0, (1 - height) * (1 + height)));
  return from_lat_long((left + 0.5 + x) / width_, height, sine);
}

}  // namespace airlight::scene
