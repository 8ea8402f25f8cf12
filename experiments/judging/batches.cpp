#include "experiments/judging/batches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

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

namespace {

std::string prefix_of(const std::string& layer) { return layer == "mean" ? "" : layer + "."; }

}  // namespace

std::span<const float> standard_errors(const scene::Film& film, const std::string& layer, const std::string& what) {
  const std::string name = prefix_of(layer) + "se";
  if (!film.has(name)) return {};
  const std::span<const float> values = finite_layer(film, name, what);
  if (std::any_of(values.begin(), values.end(), [](float x) { return x < 0; }))
    throw Error(fmt::format("{}: layer '{}' has values below 0", what, name));
  return values;
}

bool has_only_errors(const scene::Film& film, const std::string& layer, const std::string& what) {
  if (film.has(prefix_of(layer) + "batch.00") || standard_errors(film, layer, what).empty()) return false;
  if (!film.has("n")) return true;
  const std::span<const float> n = finite_layer(film, "n", what);
  return std::all_of(n.begin(), n.end(), [](float x) { return x >= 2; });
}

std::vector<float> unresolved(const scene::Film& film, const std::string& layer, const std::string& what) {
  const std::vector<std::span<const float>> groups = batches(film, layer, what);
  const std::span<const float> errors = standard_errors(film, layer, what);
  if (groups.empty() || errors.empty()) return {};
  std::vector<float> result(errors.size(), 0.0f);
  bool any = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto same = [&](const std::span<const float>& group) { return group[i] == groups.front()[i]; };
    if (errors[i] > 0 && std::all_of(groups.begin(), groups.end(), same)) {
      result[i] = errors[i];
      any = true;
    }
  }
  return any ? result : std::vector<float>();
}

std::vector<std::span<const float>> batches(const scene::Film& film, const std::string& layer,
                                            const std::string& what) {
  const std::string prefix = prefix_of(layer);
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
