#include "scene/film/film.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::scene {
namespace {

std::size_t offset_of(const Film& film, int x, int y) {
  if (x < 0 || x >= film.width || y < 0 || y >= film.height)
    throw Error(fmt::format("pixel ({}, {}) lies outside a film of {} x {}", x, y, film.width, film.height));
  return 3 * (std::size_t(y) * film.width + x);
}

}  // namespace

std::vector<float>& Film::add(const std::string& name) {
  std::vector<float>& values = layers[name];
  if (values.empty()) require_memory(12.0 * double(pixels()), fmt::format("a film of {} x {}", width, height));
  values.resize(3 * pixels(), 0.0f);
  return values;
}

const std::vector<float>& Film::layer(const std::string& name) const {
  const auto found = layers.find(name);
  if (found != layers.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : layers) names.push_back(entry.first);
  throw Error(fmt::format("the film has no layer '{}'; it has: {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void Film::set(const std::string& name, int x, int y, const Rgb& value) {
  float* pixel = add(name).data() + offset_of(*this, x, y);
  for (int c = 0; c < 3; ++c) pixel[c] = float(value[c]);
}

void require_finite(const Film& film, const std::string& what) {
  for (const auto& [name, values] : film.layers)
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) continue;
      const std::size_t pixel = i / 3, width = std::max(film.width, 1);
      const auto by = film.metadata.find("renderer");
      throw Error(fmt::format("{}: layer '{}', pixel ({}, {}), {}: found {}, expected a finite 32-bit number{}", what,
                              name, pixel % width, pixel / width, "RGB"[i % 3], values[i],
                              by == film.metadata.end() ? "" : " from " + by->second));
    }
}

Rgb Film::get(const std::string& name, int x, int y) const {
  const float* pixel = layer(name).data() + offset_of(*this, x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

}  // namespace airlight::scene
