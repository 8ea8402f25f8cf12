#include "methods/shadow_planes/lit_parts.h"

#include "methods/shadow_planes/general_position.h"
#include "scene/base/stopwatch.h"

namespace airlight::shadow_planes {
namespace {

Rgb over(const LitLight& lit, const Ray& ray, Interval part, Counts& counts) {
  Rgb sum = Rgb::Zero();
  int terms = 0;
  for (const AirlightTerm& term : lit.airlight_terms) {
    if (extent(term, ray, part).empty()) continue;
    ++terms;
    sum += airlight(term, lit.light, ray, part);
  }
  counts.parts += terms > 0;
  counts.by_pixel += terms;
  return sum;
}

// Airlight as if each shadow plane acted alone: the integral weighted with 1 - m/2.
Rgb signed_sum(const LitLight& lit, const Ray& ray, double end, int count, const std::vector<Crossing>& crossings,
               Counts& counts) {
  Rgb sum = Rgb::Zero();
  double m = count, from = 0;
  const auto add = [&](double to) {
    if (to > from && m != 2) sum += (1 - 0.5 * m) * over(lit, ray, {from, to}, counts);
    from = to;
  };
  for (const Crossing& crossing : crossings) {
    add(crossing.x);
    m += crossing.change;
  }
  add(end);
  return sum;
}

}  // namespace

void add_lit_parts(const LitLight& lit, std::optional<int> count, std::vector<Pixel>& pixels, Counts& counts,
                   StageSeconds& seconds) {
  // In two passes, so that the clock is read for a tile, not for every pixel.
  scene::Stopwatch watch;
  std::vector<int> edges;
  std::vector<Crossing> crossings;
  std::vector<ShadowVolumes::Interval> of_ray, parts;
  std::vector<std::size_t> first{0};
  const bool counted = lit.shadows && lit.how == Options::Shadows::counted;
  // Sorts the crossings and finds the lit parts, none where the ray meets no medium; m of the origin.
  const auto find = [&](const Pixel& pixel) {
    crossings.clear();
    of_ray.clear();
    if (!in_air(lit.airlight_terms, pixel.ray, pixel.end.t)) return 0;
    const Ray ray = ray_in_general_position(pixel.ray, lit.shadows->light());
    const int m = count ? *count : lit.shadows->count(ray.origin);
    lit.fan->of_ray(ray, edges);
    lit.shadows->lit_parts(ray, pixel.end.t, m, &edges, crossings, of_ray);
    return m;
  };
  if (counted)
    for (const Pixel& pixel : pixels) {
      find(pixel);
      counts.crossings += double(crossings.size());
      parts.insert(parts.end(), of_ray.begin(), of_ray.end());
      first.push_back(parts.size());
    }
  seconds.scene += watch.lap();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Pixel& pixel = pixels[i];
    if (counted) {
      for (std::size_t k = first[i]; k < first[i + 1]; ++k)
        pixel.airlight += over(lit, pixel.ray, {parts[k].begin, parts[k].end}, counts);
    } else if (!lit.shadows) {
      pixel.airlight += over(lit, pixel.ray, {0, pixel.end.t}, counts);
    } else {
      const int m = find(pixel);
      counts.crossings += double(crossings.size());
      pixel.airlight += signed_sum(lit, pixel.ray, pixel.end.t, m, crossings, counts);
    }
  }
  seconds.planes += watch.lap();
}

}  // namespace airlight::shadow_planes
