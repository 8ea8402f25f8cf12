#include "scene/light/lat_long_density.h"

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

// x in [0, 1] with density proportional to a + (b - a) x; the form without cancellation.
double sample_linear(double a, double b, double u) {
  const double denominator = a + std::sqrt(a * a + u * (b - a) * (b + a));
  return denominator > 0 ? std::min(1.0, u * (a + b) / denominator) : u;
}

}  // namespace

LatLongDensity::LatLongDensity(int width, int height, const std::vector<double>& values, const std::vector<float>& rgb)
    : width_(width), height_(height) {
  // Scaled so that no square or sum of them overflows or vanishes.
  const double largest = *std::max_element(values.begin(), values.end());
  texels_.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) texels_[i].rgb[c] = rgb.empty() ? 0.0f : rgb[3 * i + c];
    texels_[i].value = largest > 0 ? float(values[i] / largest) : 0.0f;
  }
  cosine_.resize(std::size_t(height) + 2);
  for (int j = 0; j <= height + 1; ++j) cosine_[j] = elementary::sincos_turns(strip_begin(j, height) / (2 * pi)).cos;
  strips_.resize(std::size_t(height) + 2);
  cells_.resize(std::size_t(height + 1) * (width + 1));
  cell_guide_.resize(std::size_t(height + 1) * guide_entries(width));
  for (int j = 0; j <= height; ++j) {
    const Texel *top = row(std::max(j - 1, 0)), *bottom = row(std::min(j, height - 1));
    double* cells = &cells_[std::size_t(j) * (width + 1)];
    for (int i = 0; i < width; ++i) {
      const int next = i + 1 == width ? 0 : i + 1;
      cells[i + 1] = 0.25 * ((double(top[i].value) + top[next].value) + (double(bottom[i].value) + bottom[next].value));
    }
    strips_[j + 1] = cumulate(cells, width) * (cosine_[j] - cosine_[j + 1]) * 2 * pi / width;
    make_guide(cells, width, &cell_guide_[std::size_t(j) * guide_entries(width)]);
  }
  total_ = cumulate(strips_.data(), height + 1);
  strip_guide_.resize(guide_entries(height + 1));
  make_guide(strips_.data(), height + 1, strip_guide_.data());
}

void LatLongDensity::make_guide(const double* shares, int bins, std::uint32_t* guide) {
  const int entries = guide_entries(bins);
  int bin = 0;
  for (int k = 0; k < entries; ++k) {
    while (bin + 1 < bins && shares[bin + 1] <= double(k) / (entries - 1)) ++bin;
    guide[k] = std::uint32_t(bin);
  }
}

// The bin that u falls into, never an empty one; u becomes the position within the bin, in [0, 1].
int LatLongDensity::choose(const double* shares, int bins, const std::uint32_t* guide, double& u) {
  const int stretches = guide_entries(bins) - 1;
  const int k = std::clamp(int(u * stretches), 0, stretches - 1);
  // Rounding of u * stretches may put u on the border of the next stretch.
  int bin = int(guide[k]);
  while (bin > 0 && shares[bin] > u) --bin;
  // The last bin that begins at or before u; empty bins begin where the next one does.
  bin = int(std::upper_bound(shares + bin + 1, shares + guide[k + 1] + 1, u) - shares) - 1;
  while (bin > 0 && !(shares[bin + 1] > shares[bin])) --bin;  // u at the very end
  u = std::clamp((u - shares[bin]) / (shares[bin + 1] - shares[bin]), 0.0, 1.0);
  return bin;
}

Rgb LatLongDensity::colour(const LatLongCell& cell) const {
  const auto along = [&](const Texel* texels) {
    const float *a = texels[cell.left].rgb, *b = texels[cell.right].rgb;
    return Rgb((1 - cell.x) * Rgb(a[0], a[1], a[2]) + cell.x * Rgb(b[0], b[1], b[2]));
  };
  return (1 - cell.y) * along(row(cell.top)) + cell.y * along(row(cell.bottom));
}

double LatLongDensity::pdf(const LatLongCell& cell, double direction_y) const {
  const Texel *top = row(cell.top), *bottom = row(cell.bottom);
  const auto between = [](double a, double b, double x) { return a + (b - a) * x; };
  const double above = between(top[cell.left].value, top[cell.right].value, cell.x);
  const double below = between(bottom[cell.left].value, bottom[cell.right].value, cell.x);
  const double y = (cosine_[cell.strip] - direction_y) / (cosine_[cell.strip] - cosine_[cell.strip + 1]);
  return between(above, below, std::clamp(y, 0.0, 1.0)) / total_;
}

Vec3 LatLongDensity::sample(double u1, double u2) const {
  const int strip = choose(strips_.data(), height_ + 1, strip_guide_.data(), u1);
  const std::size_t s = std::size_t(strip);
  const int left = choose(&cells_[s * (width_ + 1)], width_, &cell_guide_[s * guide_entries(width_)], u2);
  const int right = left + 1 == width_ ? 0 : left + 1;
  const Texel *top = row(std::max(strip - 1, 0)), *bottom = row(std::min(strip, height_ - 1));
  const double a = top[left].value, b = top[right].value, c = bottom[left].value, d = bottom[right].value;
  const double y = sample_linear(a + b, c + d, u1);
  const double x = sample_linear(a + (c - a) * y, b + (d - b) * y, u2);
  const double height = cosine_[strip] + (cosine_[strip + 1] - cosine_[strip]) * y;
  const double sine = std::sqrt(std::max(0.0, (1 - height) * (1 + height)));
  return from_lat_long((left + 0.5 + x) / width_, height, sine);
}

}  // namespace airlight::scene
