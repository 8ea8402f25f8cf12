// Films whose noise is known.
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "scene/film/film.h"

namespace airlight::test {

using scene::Film;
using Value = std::function<double(int x, int y, int c)>;

inline double gradient(int x, int y, int c) { return 1 + 0.05 * x + 0.02 * y + 0.3 * c; }

inline Film exact(int w, int h, const Value& value) {
  Film film(w, h);
  auto& mean = film.add("mean");
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int c = 0; c < 3; ++c) mean[std::size_t(3 * (y * w + x) + c)] = float(value(x, y, c));
  return film;
}

inline std::string batch_name(int b) { return (b < 10 ? "batch.0" : "batch.") + std::to_string(b); }

// Relative noise of one batch in the three channels of a pixel.
using Noise = std::function<std::array<double, 3>(std::mt19937_64&)>;

// Sixteen batches of independent noise.
inline Film noisy(int w, int h, const Value& value, const Noise& noise, unsigned seed) {
  Film film(w, h);
  std::mt19937_64 random(seed);
  auto& mean = film.add("mean");
  for (int b = 0; b < 16; ++b) {
    auto& batch = film.add(batch_name(b));
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const auto draw = noise(random);
        for (int c = 0; c < 3; ++c)
          batch[std::size_t(3 * (y * w + x) + c)] = float(value(x, y, c) * (1 + draw[std::size_t(c)]));
      }
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += batch[i] / 16;
  }
  return film;
}

// Gamma distributed with shape 2 (skewness 1.4), the channels apart; the mean has standard deviation `sigma` times the
// value.
inline Film noisy(int w, int h, const Value& value, double sigma, unsigned seed) {
  std::gamma_distribution<double> gamma(2, 1);
  const auto one = [&](std::mt19937_64& random) { return (gamma(random) - 2) / std::sqrt(2.0) * sigma * 4; };
  const Noise noise = [&](std::mt19937_64& random) {
    const double r = one(random), g = one(random);
    return std::array<double, 3>{r, g, one(random)};
  };
  return noisy(w, h, value, noise, seed);
}

}  // namespace airlight::test
