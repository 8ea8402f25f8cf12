// Delta tracking and ratio tracking: collisions between local majorants, null ones counted and passed over.
#include <algorithm>

#include "reference/path_tracer/media.h"
#include "reference/path_tracer/sampling.h"
#include "scene/base/error.h"
#include "scene/math/elementary.h"

namespace airlight::path_tracer {
namespace {

// Which random numbers a flight takes; tracking itself begins at track().
// Flights of one vertex share 2^24 random blocks: 2^18 for each of up to 64 media. So do the transmittances of its four
// branches (light, and three segments of a connection): 2^16 for each medium.
// The second to eighth tries of a first collision have 2^15 each, later ones 2^11.
constexpr std::uint32_t flight_blocks = 1u << 18, branch_blocks = 1u << 16, retry_blocks = 1u << 15,
                        late_blocks = 1u << 11;
constexpr int retries = 7;
static_assert((most_attempts - retries - 1) * most_media * late_blocks <= 1 << 24);

// The random numbers of one flight, two from each block of a range.
class Uniforms {
 public:
  Uniforms(const SampleRandom& random, std::uint32_t vertex, Purpose purpose, std::uint32_t first, std::uint32_t count)
      : random_(random), vertex_(vertex), purpose_(purpose), index_(first), end_(first + count) {}

  double next() {
    if (used_ == 2) {
      if (++index_ == end_)
        throw Error("path_tracer: a flight used up its random numbers, expected a tighter majorant");
      block_ = random_.block(vertex_, purpose_, index_);
      used_ = 0;
    }
    return block_.fine(used_++);
  }

 private:
  const SampleRandom& random_;
  std::uint32_t vertex_;
  Purpose purpose_;
  std::uint32_t index_, end_;
  RandomBlock block_ = random_.block(vertex_, purpose_, index_);
  int used_ = 0;
};

// Where the numbers of an attempt lie: the how manieth it is of its purpose, and how many blocks each has.
struct Tries {
  Purpose purpose;
  int number;
  std::uint32_t blocks;
};
Tries tries_of(int attempt) {
  if (attempt == 0) return {Purpose::flight, 0, flight_blocks};
  if (attempt <= retries) return {Purpose::retry, attempt - 1, retry_blocks};
  return {Purpose::late_retry, attempt - retries - 1, late_blocks};
}

// Calls visit(t, density, majorant) at the collisions that a medium of the majorants' extinction, times sigma, would
// cause along the range, until it returns true. The first one lies an optical depth of `depth` ahead.
template <class Visit>
void track(const TrackedMedium& tracked, const Ray& ray, Interval range, double sigma, double depth, Uniforms& uniforms,
           Counters& counters, Visit&& visit) {
  const Ray tracking = tracked.tracking_ray(ray);
  walk(tracked.majorants, tracking, range, [&](double begin, double end, double majorant) {
    if (!(majorant > 0)) return false;
    const double rate = sigma * majorant;
    for (double t = begin;;) {
      const double step = depth / rate;
      if (!(t + step < end)) {
        depth = std::max(0.0, depth - (end - t) * rate);
        return false;
      }
      t += step;
      const double density = tracked.density_at(tracking.at(t));
      ++counters.lookups;
      if (density > majorant * (1 + 1e-6)) ++counters.violations;
      if (visit(t, density, majorant)) return true;
      depth = -elementary::log(uniforms.next());
    }
  });
}

// Integral of the majorants over the range.
double majorant_column(const TrackedMedium& tracked, const Ray& ray, Interval range) {
  if (range.empty()) return 0;
  if (tracked.homogeneous) return tracked.constant > 0 ? tracked.constant * range.length() : 0;
  double column = 0;
  walk(tracked.majorants, tracked.tracking_ray(ray), range, [&](double begin, double end, double majorant) {
    if (majorant > 0) column += majorant * (end - begin);
    return false;
  });
  return column;
}

}  // namespace

std::optional<Collision> Media::fly(const Ray& ray, double tmax, int hero, const SampleRandom& random,
                                    std::uint32_t vertex, int attempt, double any_tentative, Counters& counters) const {
  const Tries tries = tries_of(attempt);
  std::optional<Collision> nearest;
  enum { not_drawn, drawn, past } forced = any_tentative < 1 ? not_drawn : past;
  // A forced collision lies `ahead` in majorant depth. Medium after medium takes its own off, until it falls into one; the last takes the rest.
  // Media after that are flown through freely.
  double ahead = 0;
  for (std::size_t m = 0; m < tracked_.size(); ++m) {
    const TrackedMedium& tracked = tracked_[m];
    const Interval range = scene::extent(*tracked.medium, ray, {0, nearest ? nearest->t : tmax});
    const double sigma = tracked.medium->sigma_t[hero];
    if (range.empty() || !(sigma > 0)) continue;
    const std::uint32_t number = std::uint32_t(tries.number) * std::uint32_t(most_media) + std::uint32_t(m);
    Uniforms uniforms(random, vertex, tries.purpose, number * tries.blocks, tries.blocks);

    // Depth to the first tentative collision: exponential, or the rest of a forced one's.
    double depth;
    if (forced == past) {
      depth = -elementary::log(uniforms.next());
    } else {
      if (forced == not_drawn) ahead = truncated_exponential(uniforms.next(), any_tentative);
      forced = drawn;
      const double column = m + 1 < tracked_.size() ? sigma * majorant_column(tracked, ray, range) : infinity;
      if (ahead >= column) {
        ahead -= column;
        continue;
      }
      depth = ahead;
      forced = past;
    }

    // A homogeneous medium has no null collisions.
    if (tracked.homogeneous) {
      const double t = range.lo + depth / (sigma * tracked.constant);
      if (t < range.hi) nearest = {t, int(m), tracked.constant};
      continue;
    }

    // Delta tracking: a tentative collision is real with probability density / majorant.
    track(tracked, ray, range, sigma, depth, uniforms, counters, [&](double t, double density, double majorant) {
      if (!(uniforms.next() * majorant < density)) return false;
      nearest = {t, int(m), density};
      return true;
    });
  }
  if (nearest) ++counters.collisions;
  return nearest;
}

Rgb Media::majorant_depth(const Ray& ray, double tmax) const {
  Rgb depth = Rgb::Zero();
  for (const TrackedMedium& tracked : tracked_) {
    const double column = majorant_column(tracked, ray, scene::extent(*tracked.medium, ray, {0, tmax}));
    for (int c = 0; c < 3; ++c)
      if (tracked.medium->sigma_t[c] > 0 && column > 0) depth[c] += tracked.medium->sigma_t[c] * column;
  }
  return depth;
}

Rgb Media::ratio_transmittance(const Ray& ray, double tmax, const SampleRandom& random, std::uint32_t vertex,
                               std::uint32_t branch, Counters& counters) const {
  double product = 1;
  for (std::size_t m = 0; m < tracked_.size(); ++m) {
    const TrackedMedium& tracked = tracked_[m];
    const double sigma = tracked.medium->sigma_t[0];
    const Interval range = scene::extent(*tracked.medium, ray, {0, tmax});
    if (range.empty() || !(sigma > 0)) continue;
    if (tracked.homogeneous) {
      product *= elementary::exp(-sigma * tracked.constant * range.length());
      continue;
    }
    const std::uint32_t first = branch * std::uint32_t(most_media) * branch_blocks + std::uint32_t(m) * branch_blocks;
    Uniforms uniforms(random, vertex, Purpose::transmittance, first, branch_blocks);
    const double depth = -elementary::log(uniforms.next());
    track(tracked, ray, range, sigma, depth, uniforms, counters, [&](double, double density, double majorant) {
      product *= 1 - density / majorant;
      return product == 0;
    });
  }
  return Rgb::Constant(product);
}

}  // namespace airlight::path_tracer
