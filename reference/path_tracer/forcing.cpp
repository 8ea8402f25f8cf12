#include "reference/path_tracer/forcing.h"

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/sampling.h"

namespace airlight::path_tracer {
namespace {

constexpr double thin = 0.05;         // optical depth of a scene below which its collisions are boosted,
constexpr double collides = 0.5;      // to this probability on its longest way
constexpr double most_missed = 0.03;  // of forced flights without a collision, where tries allow
constexpr int most_tries = 8;
// All collisions of a thin segment may be alike, and samples must not all succeed, and agree, where some would not:
// misses are made so rare that they matter to nobody, or are common enough to be among the samples. Deeper in, the
// attenuation of 64 samples differs by more than a sixth of `most_missed`: depth / 3 / sqrt(64).
constexpr double alike = 0.12, rarest_miss = 1e-9, common_miss = 0.2;

// At most log(1e-9) / log(1 - 0.18) = 105, and 1 / 0.18 on the average.
int tries_where_alike(double success) {
  if (success >= 1) return 1;
  const double miss = log1p(-success);  // of one try
  if (most_tries * miss > elementary::log(common_miss)) return most_tries;
  return int(std::ceil(elementary::log(rarest_miss) / miss));
}

// Probability of an exponential variate of mean 1 below depth.
double some_collision(double depth) { return -expm1(-depth); }

// Everything of finite size: what bounds the segments in a medium that nothing bounds.
Box contents(const scene::Scene& scene) {
  Box all{scene.camera.position, scene.camera.position};
  const auto add = [&](const Box& box) {
    if (!box.empty() && (box.size().array() < infinity).all()) all = unite(all, box);
  };
  for (const scene::Medium& medium : scene.media) add(scene::bounding_box(medium));
  for (const scene::Light& light : scene.lights)
    if (const auto ball = scene::ball(light)) add({ball->center, ball->center});
  if (scene.geometry) add(scene.geometry->bounds());
  return all;
}

}  // namespace

Flight force(const Media& media, const Ray& ray, double tmax, double boost, Counters& counters) {
  Flight flight;
  flight.forced = true;
  const Rgb depth = media.optical_depth(ray, tmax, counters);
  const Rgb tentative = media.homogeneous() ? depth : media.majorant_depth(ray, tmax);
  flight.transmittance = media.transmittance(depth);
  // Probabilities of a collision: of an analog flight, of a forced one. In grey media the channels are one.
  const int channels = media.grey() ? 1 : 3;
  const auto for_each_channel = [&](Rgb& result, auto of) {
    for (int c = 0; c < channels; ++c) result[c] = of(c);
    if (channels == 1) result = Rgb::Constant(result[0]);
  };
  Rgb real, wanted;
  for_each_channel(real, [&](int c) { return some_collision(depth[c]); });
  const bool collides_anyway = real.mean() >= 1 - most_missed;
  for_each_channel(flight.flight_probability, [&](int c) { return real[c] > 0 ? std::min(1.0, boost * real[c]) : 0; });
  if (!collides_anyway) for_each_channel(flight.any_tentative, [&](int c) { return some_collision(tentative[c]); });
  for_each_channel(wanted, [&](int c) {
    return flight.any_tentative[c] > 0 ? std::min(1.0, real[c] / flight.any_tentative[c]) : 1;
  });
  if (real.maxCoeff() < alike) {
    flight.tries = tries_where_alike((real > 0).select(wanted, 1).minCoeff());
  } else {
    double missed = 1 - wanted.mean();
    for (; flight.tries < most_tries && missed > most_missed; ++flight.tries) missed *= 1 - wanted.mean();
  }
  for_each_channel(flight.gain, [&](int c) {
    const double success = wanted[c] < 1 ? -expm1(flight.tries * log1p(-wanted[c])) : 1.0;
    return real[c] > 0 ? flight.flight_probability[c] * success / real[c] : 1.0;
  });
  return flight;
}

double collision_boost(const scene::Scene& scene) {
  const double size = contents(scene).size().norm();
  double depth = 0;
  for (const scene::Medium& medium : scene.media) {
    const Box box = scene::bounding_box(medium);
    if (box.empty()) continue;
    Point3 middle = scene.camera.position;
    for (int a = 0; a < 3; ++a)
      if (std::isfinite(box.size()[a])) middle[a] = box.center()[a];
    double most = 0;
    for (int i = 0; i < 13; ++i) {  // axes and diagonals
      const int code = i + 14;
      const Vec3 direction = Vec3(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).normalized();
      most = std::max(most, scene::density_integral(medium, {middle, direction}, {0, size}) +
                                scene::density_integral(medium, {middle, -direction}, {0, size}));
    }
    if (most > 0) depth += medium.sigma_t.maxCoeff() * most;
  }
  return depth > 0 && depth < thin ? collides / depth : 1.0;
}

}  // namespace airlight::path_tracer
