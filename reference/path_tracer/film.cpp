// The sums of an accumulation as a picture with its layers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "reference/path_tracer/accumulation.h"
#include "reference/path_tracer/certainty.h"
#include "scene/base/error.h"

namespace airlight::path_tracer {
namespace {

Rgb entry(const double* sums, int e) { return {sums[3 * e], sums[3 * e + 1], sums[3 * e + 2]}; }

// Standard error of the mean of n values with these sums.
Rgb standard_error(const Rgb& sum, const Rgb& square, double n) {
  if (n < 2) return Rgb::Zero();
  return ((square - sum * sum / n).max(0.0) / (n * (n - 1))).sqrt();
}

// Noise-free, along the pixel's centre or the mean over a 4 x 4 pattern in the pixel.
Rgb pixel_transmittance(const World& world, const scene::View& view, int x, int y, Counters& counters) {
  const int n = world.options().box_pixels ? 4 : 1;
  Rgb sum = Rgb::Zero();
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Ray ray = scene::camera_ray(view.camera, x + (i + 0.5) / n, y + (j + 0.5) / n, view.width, view.height);
      sum += world.media().transmittance(ray, scene::camera_end(world.scene(), ray).t, counters);
    }
  return sum / (n * n);
}

// Orders whose standard error over the whole film is above half their mean, and those that are 0 though light could
// come: their samples prove nothing.
std::string unresolved(const World& world, const Accumulation& a) {
  const TallyLayout& layout = a.layout;
  if (!layout.order_squares) return {};
  std::vector<std::string> names;
  bool scatters = false;
  for (const TrackedMedium& tracked : world.media().tracked())
    scatters = scatters || (tracked.medium->albedo * tracked.medium->sigma_t).maxCoeff() > 0;
  if (!scatters || !world.lights().any()) return {};
  for (int m = 1; m <= layout.orders + 1; ++m) {
    if (world.options().max_order >= 0 && m > world.options().max_order) break;
    if (world.options().max_events >= 0 && m > world.options().max_events) break;
    if (world.options().only_lit_surfaces() && m > 1) break;
    double mean = 0, variance = 0;
    for (const auto& nodes : a.tiles) {
      const TallyNode node = fold(layout, nodes);
      if (node.count == 0) continue;
      for (std::size_t at = 0; at < node.sums.size(); at += layout.doubles()) {
        const Rgb sum = entry(&node.sums[at], layout.order(m));
        mean += (sum / double(node.count)).sum();
        // The channels share their paths: their errors add, as if they were one.
        const Rgb square = entry(&node.sums[at], layout.order_square(m));
        const double error = standard_error(sum, square, double(node.count)).sum();
        variance += error * error;
      }
    }
    if (!(std::sqrt(variance) <= 0.5 * std::abs(mean)) || mean == 0)
      names.push_back(m <= layout.orders ? fmt::format("order.{}", m) : "order.rest");
  }
  return fmt::format("{}", fmt::join(names, " "));
}

// Greatest sample of a picture by magnitude. Negative samples are only stored as sums, so that their mean is used.
Rgb greatest_sample(const TallyLayout& layout, const std::vector<TallyNode>& tiles) {
  Rgb greatest = Rgb::Zero();
  for (const TallyNode& tile : tiles)
    for (std::size_t at = 0; at < tile.sums.size(); at += layout.doubles())
      greatest = greatest.max(entry(&tile.sums[at], layout.greatest()))
                     .max(-entry(&tile.sums[at], layout.negative()) / double(tile.count));
  return greatest;
}

std::string ranges(const std::vector<TallyNode>& nodes) {
  std::vector<std::string> parts;
  for (std::size_t n = 0; n < nodes.size();) {
    const std::uint64_t begin = nodes[n].begin();
    std::uint64_t end = begin;
    for (; n < nodes.size() && nodes[n].begin() == end; ++n) end = nodes[n].end();
    parts.push_back(fmt::format("{}..{}", begin, end));
  }
  return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace

scene::Film to_film(const World& world, const scene::View& view, const Accumulation& a) {
  const TallyLayout& layout = a.layout;
  scene::Film film(a.width, a.height);
  const auto order_name = [&](int m) { return m <= layout.orders ? fmt::format("order.{}", m) : "order.rest"; };
  const bool capped = world.options().max_order >= 0 || world.options().max_events >= 0;
  bool equal_batches = true;
  for (const auto& nodes : a.tiles)
    for (const TallyNode& node : nodes) equal_batches = equal_batches && node.count % batch_count == 0;

  std::vector<TallyNode> folded;
  for (const auto& nodes : a.tiles) folded.push_back(fold(layout, nodes));
  const Rgb greatest = greatest_sample(layout, folded);
  bool negative = false, might = false;
  std::uint64_t least = ~std::uint64_t(0), most = 0;
  Counters columns;
  for (int tile = 0; tile < int(a.tiles.size()); ++tile) {
    const TallyNode& node = folded[tile];
    least = std::min(least, node.count);
    most = std::max(most, node.count);
    const int x0 = tile % a.tiles_across() * tile_size, y0 = tile / a.tiles_across() * tile_size;
    const int x1 = std::min(x0 + tile_size, a.width), y1 = std::min(y0 + tile_size, a.height);
    const std::vector<double> nothing(layout.doubles(), 0.0);
    const double* sums = node.sums.data();
    const double n = double(node.count), per_sample = n > 0 ? 1 / n : 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double* pixel = n > 0 ? sums : nothing.data();
        if (n > 0) sums += layout.doubles();
        const auto set = [&](const std::string& name, const Rgb& value) { film.set(name, x, y, value); };
        set("mean", entry(pixel, layout.mean()) * per_sample);
        const Rgb sum = entry(pixel, layout.mean()), square = entry(pixel, layout.square());
        const auto may = may_shine(world, view, x, y);
        Rgb error;
        for (int c = 0; c < 3; ++c) {
          error[c] = honest_error(sum[c], square[c], n, greatest[c], may[c]);
          might = might || may[c];
        }
        set("se", error);
        set("max_sample", entry(pixel, layout.greatest()));
        set("airlight", entry(pixel, layout.airlight()) * per_sample);
        set("surface", entry(pixel, layout.surface()) * per_sample);
        set("n", Rgb::Constant(n));
        set("transmittance", pixel_transmittance(world, view, x, y, columns));
        for (int m = 0; m <= layout.orders + 1; ++m) set(order_name(m), entry(pixel, layout.order(m)) * per_sample);
        if (capped) set("truncated", entry(pixel, layout.truncated()) * per_sample);
        set("negative", entry(pixel, layout.negative()) * per_sample);
        negative = negative || (entry(pixel, layout.negative()) < 0).any();
        if (equal_batches && n > 0) {
          Rgb half[2] = {Rgb::Zero(), Rgb::Zero()};
          for (int b = 0; b < batch_count; ++b) {
            const Rgb mean = entry(pixel, layout.batch(b)) * (batch_count * per_sample);
            half[b / (batch_count / 2)] += mean / (batch_count / 2);
            set(fmt::format("batch.{:02}", b), mean);
          }
          set("half.A", half[0]);
          set("half.B", half[1]);
        }
      }
  }
  if (!negative) film.layers.erase("negative");
  scene::require_finite(film, fmt::format("path_tracer: scene '{}'", world.scene().name));

  auto& metadata = film.metadata;
  metadata["renderer"] = "path_tracer";
  metadata["scene"] = world.scene().name;
  metadata["scene_hash"] = a.identity.scene;
  metadata["view_hash"] = a.identity.view;
  metadata["settings"] = a.identity.settings;
  metadata["seed"] = fmt::format("{}", a.identity.seed);
  metadata["stream"] = fmt::format("{}", a.identity.stream);
  metadata["build"] = a.identity.build;
  metadata["samples"] = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
  if (least == most && !a.tiles.empty()) metadata["sample_ranges"] = ranges(a.tiles.front());
  metadata["seconds"] = fmt::format("{:.3f}", a.seconds);
  std::string names = unresolved(world, a);
  if (might && (greatest == 0).all()) {
    names = names.empty() ? "mean" : "mean " + names;
    metadata["warning"] = fmt::format(
        "path_tracer: none of {} samples per pixel brought light to any pixel, though light may come: the picture's 0 "
        "is no evidence",
        metadata["samples"]);
  }
  if (!names.empty()) metadata["unresolved"] = names;
  for (const auto& [name, value] : a.counters.named()) metadata[name] = fmt::format("{}", value);
  return film;
}

}  // namespace airlight::path_tracer
