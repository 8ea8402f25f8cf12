#include "experiments/batches.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/error.h"

namespace airlight::experiments {

std::span<const float> finite_layer(const scene::Film& film, const std::string& layer, const std::string& what) {
  const std::vector<float>& values = film.layer(layer);
  if (values.size() != 3 * film.pixels())
    throw Error(
        fmt::format("{}: layer '{}' has {} values, expected {}", what, layer, values.size(), 3 * film.pixels()));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Error(fmt::format("{}: layer '{}' is {} at pixel ({}, {}), expected a finite number", what, layer,
                              values[i], i / 3 % std::size_t(film.width), i / 3 / std::size_t(film.width)));
  return values;
}

std::vector<std::span<const float>> batches(const scene::Film& film, const std::string& layer,
                                            const std::string& what) {
  const std::string prefix = layer == "mean" ? "" : layer + ".";
  std::vector<std::span<const float>> found;
  for (int i = 0;; ++i) {
    const std::string name = fmt::format("{}batch.{:02}", prefix, i);
    if (!film.has(name)) break;
    found.push_back(finite_layer(film, name, what));
  }
  const bool noisy = film.has("se") || film.has("batch.00") || film.has(prefix + "se");
  if (noisy && found.size() < 4)
    throw Error(
        fmt::format("{}: layer '{}' is noisy and has {} batches, expected 4 or more (a Monte Carlo image is "
                    "compared in a layer whose batches are stored)",
                    what, layer, found.size()));
  return found;
}

}  // namespace airlight::experiments
