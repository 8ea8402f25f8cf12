#include "reference/half_resolution_march/march.h"

#include <algorithm>
#include <cmath>

namespace airlight::half_resolution_march {
namespace {

// Transmittance of a step of this optical depth, and the rest to 1: the smaller of the two to all its
// digits, by one exponential.
struct Share {
  double through, taken;
};
Share share_of(double depth) {
  if (depth > 0.6) {
    const double through = std::exp(-depth);
    return {through, 1 - through};
  }
  const double taken = -std::expm1(-depth);
  return {1 - taken, taken};
}

// Ends a stretch where endless media are `horizon` deep.
void cut(const lit_media::LitMedia& media, const Ray& ray, Stretch& stretch) {
  Rgb endless = Rgb::Zero();  // extinction that never ends [1/m]
  double begin = 0, finite = 0;
  for (const ray_marcher::Layer& layer : media.layers()) {
    const Interval constant = constant_extent(layer, ray, {0, infinity});
    const Interval varied = varied_extent(layer, ray, {0, infinity});
    if (!varied.empty()) finite = std::max(finite, varied.hi);
    if (constant.empty()) continue;
    if (constant.hi < infinity) {
      finite = std::max(finite, constant.hi);
      continue;
    }
    endless += layer.constant * layer.medium->sigma_t;
    begin = std::max(begin, constant.lo);
  }
  if ((endless == 0).all()) return;
  double thinnest = infinity;
  for (int c = 0; c < 3; ++c)
    if (endless[c] > 0) thinnest = std::min(thinnest, endless[c]);
  double end = begin + horizon / thinnest;
  // A channel that sees through endless fog sees everything else.
  if (!(endless > 0).all()) end = std::max(end, finite);
  if (!(end < stretch.t.hi)) return;
  stretch.t.hi = end;
  stretch.beyond = (endless > 0).select(Rgb(Rgb::Zero()), stretch.beyond);
}

}  // namespace

Stretch marched_stretch(const lit_media::LitMedia& media, const Ray& ray, double t_end, bool from_camera) {
  Stretch stretch{media.extent(ray, {0, t_end})};
  if (stretch.t.empty()) return stretch;
  cut(media, ray, stretch);
  stretch.in_media = stretch.t.length();
  if (from_camera) stretch.t.lo = 0;
  return stretch;
}

Fog march(const lit_media::LitMedia& media, const Options& options, const Ray& ray, const Stretch& stretch,
          double offset, Steps& steps, lit_media::Counters& counters) {
  Fog fog;
  if (stretch.t.empty()) return fog;
  const double h = stretch.t.length() / options.steps;
  steps.t.resize(std::size_t(options.steps));
  for (int i = 0; i < options.steps; ++i) steps.t[std::size_t(i)] = stretch.t.lo + (i + offset) * h;
  media.along(ray, steps.t, steps.samples, counters);
  double weighted = 0;  // distances, by the airlight from there
  for (std::size_t i = 0; i < steps.t.size(); ++i) {
    const Rgb& extinction = steps.samples.extinction[i];
    if ((extinction == 0).all()) continue;
    const Rgb& source = steps.samples.source[i];
    const double before = options.reproject ? fog.airlight.sum() : 0;
    Share share{1, 0};
    for (int c = 0; c < 3; ++c) {
      const double k = extinction[c];
      if (c == 0 || k != extinction[c - 1]) share = share_of(k * h);
      const double length = !options.analytic ? h * share.through : k > 0 ? share.taken / k : h;
      fog.airlight[c] += fog.transmittance[c] * source[c] * length;
      fog.transmittance[c] *= share.through;
    }
    if (options.reproject) weighted += (fog.airlight.sum() - before) * steps.t[i];
  }
  if (options.reproject) {
    const double airlight = fog.airlight.sum();
    fog.distance = airlight > 0 ? weighted / airlight : 0.5 * (stretch.t.lo + stretch.t.hi);
  }
  fog.transmittance *= stretch.beyond;
  return fog;
}

}  // namespace airlight::half_resolution_march
