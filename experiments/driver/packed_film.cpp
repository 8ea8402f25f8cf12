#include "experiments/driver/packed_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/judging/batches.h"
#include "scene/base/error.h"
#include "scene/film/film_exr.h"
#include "scene/math/random.h"

namespace airlight::experiments {
namespace {

constexpr double least_step = 0x1p-126;  // the least normal number of single precision

std::string before_batch(const std::string& layer) { return layer == "mean" ? "" : layer + "."; }
std::string batch_name(const std::string& layer, std::size_t b) {
  return fmt::format("{}batch.{:02}", before_batch(layer), b);
}
// Not named as batches: who reads the file as it is must not take steps for radiance.
std::string steps_name(std::size_t b) { return fmt::format("steps.{:02}", b); }

// Channels of a pixel share the number: where they share their samples too, they stay equal, and compress.
double dither(std::size_t pixel, std::size_t batch) {
  return uniform32(philox4x32_10({std::uint32_t(pixel), std::uint32_t(batch), 0, 0}, {32, 0})[0]);
}

struct Scatter {
  double mean = 0, deviation = 0;
};

// Mean and deviation of value i over the batches. The deviation is 0 only if all are equal.
template <class Batches>
Scatter scatter(const Batches& batches, std::size_t i) {
  const double n = double(batches.size());
  Scatter s;
  const auto equal = [&](const auto& batch) { return batch[i] == batches[0][i]; };
  if (std::all_of(batches.begin(), batches.end(), equal)) return {double(batches[0][i]), 0};
  for (const auto& batch : batches) s.mean += batch[i] / n;
  for (const auto& batch : batches) s.deviation += (batch[i] - s.mean) * (batch[i] - s.mean) / (n - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

}  // namespace

void write_packed(const std::string& path, const scene::Film& film, const std::string& layer) {
  const auto values = finite_layer(film, layer, path);
  const auto groups = batches(film, layer, path);
  const auto errors = standard_errors(film, layer, path);
  scene::Film packed(film.width, film.height);
  packed.metadata = film.metadata;
  packed.metadata["layer"] = layer;
  std::vector<float>& base = packed.add(layer);
  if (groups.empty()) {
    std::copy(values.begin(), values.end(), base.begin());
    packed.metadata["kept"] = fmt::format("layer {} exactly", layer);
    scene::write_exr(path, packed);
    return;
  }
  std::vector<float>&step = packed.add("step"), &error = packed.add("se");
  std::vector<std::vector<float>*> counts;
  std::set<std::string> halves;
  for (std::size_t b = 0; b < groups.size(); ++b) {
    counts.push_back(&packed.add(steps_name(b)));
    halves.insert(steps_name(b));
  }
  double noise = 0, added = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Scatter s = scatter(groups, i);
    if (s.deviation == 0) {
      base[i] = groups[0][i];
      if (!errors.empty()) error[i] = errors[i];
      continue;
    }
    step[i] = float(std::max(least_step, std::exp2(std::floor(std::log2(s.deviation)))));
    base[i] = float(std::round(s.mean / step[i]) * step[i]);
    for (std::size_t b = 0; b < groups.size(); ++b) {
      const double steps = (double(groups[b][i]) - base[i]) / step[i];
      (*counts[b])[i] = float(std::floor(steps + dither(i / 3, b)));
    }
    noise += s.deviation * s.deviation;
    added += double(step[i]) * step[i] / 12;
  }
  packed.metadata["kept"] = fmt::format(
      "layer {} as {} batches, each rounded at random to steps of 0.5 to 1 times their scatter: {:.1f} % of noise "
      "(variance) added, no bias",
      layer, groups.size(), noise > 0 ? 100 * added / noise : 0);
  scene::write_exr_with_halves(path, packed, halves);
}

scene::Film read_packed(const std::string& path) {
  const scene::Film packed = scene::read_exr(path);
  const auto layer_entry = packed.metadata.find("layer");
  if (layer_entry == packed.metadata.end() || !packed.metadata.count("kept"))
    throw Error(fmt::format("{}: no committed reference: its metadata names no layer", path));
  const std::string layer = layer_entry->second;
  scene::Film film(packed.width, packed.height);
  film.metadata = packed.metadata;
  const std::vector<float>& base = packed.layer(layer);
  std::vector<float>& mean = film.add(layer);
  mean = base;
  if (!packed.has("step")) return film;
  const std::vector<float>& step = packed.layer("step");
  std::vector<std::vector<float>*> groups;
  for (std::size_t b = 0; packed.has(steps_name(b)); ++b) {
    const std::vector<float>& counts = packed.layer(steps_name(b));
    std::vector<float>& batch = film.add(batch_name(layer, b));
    for (std::size_t i = 0; i < batch.size(); ++i)
      batch[i] = float(base[i] + (counts[i] + 0.5 - dither(i / 3, b)) * step[i]);
    groups.push_back(&batch);
  }
  std::vector<float>& error = film.add(before_batch(layer) + "se");
  error = packed.layer("se");
  const double n = double(groups.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    if (step[i] == 0) continue;
    double sum = 0, squares = 0;
    for (const auto* batch : groups) sum += (*batch)[i];
    for (const auto* batch : groups) squares += ((*batch)[i] - sum / n) * ((*batch)[i] - sum / n);
    mean[i] = float(sum / n);
    error[i] = float(std::sqrt(squares / (n * (n - 1))));
  }
  return film;
}

}  // namespace airlight::experiments
