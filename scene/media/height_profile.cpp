#include "scene/media/height_profile.h"

#include <algorithm>
#include <cmath>

#include "scene/base/kinds.h"

namespace airlight::scene {
namespace {

double at(const Layers& layers, double y) {
  const auto& heights = layers.heights;
  const std::size_t after = std::size_t(std::upper_bound(heights.begin(), heights.end(), y) - heights.begin());
  if (after == 0) return layers.factors.front();
  if (after == heights.size()) return layers.factors.back();
  const double s = (y - heights[after - 1]) / (heights[after] - heights[after - 1]);
  return layers.factors[after - 1] + s * (layers.factors[after] - layers.factors[after - 1]);
}

double at(const ExponentialFall& fall, double y) {
  return y <= fall.base ? 1 : std::exp((fall.base - y) / fall.scale_height);
}

}  // namespace

std::string profile_name(const HeightProfile& profile) {
  return match(
      profile, [](const SameAtAllHeights&) { return "none"; }, [](const Layers&) { return "layers"; },
      [](const ExponentialFall&) { return "exponential"; });
}

double factor_at(const HeightProfile& profile, double y) {
  return match(
      profile, [](const SameAtAllHeights&) { return 1.0; }, [&](const Layers& layers) { return at(layers, y); },
      [&](const ExponentialFall& fall) { return at(fall, y); });
}

Interval factor_bounds(const HeightProfile& profile, Interval y) {
  return match(
      profile,
      [](const SameAtAllHeights&) {
        return Interval{1, 1};
      },
      [&](const Layers& layers) {
        const double first = at(layers, y.lo), last = at(layers, y.hi);
        Interval bounds{std::min(first, last), std::max(first, last)};
        for (std::size_t k = 0; k < layers.heights.size(); ++k) {
          if (!(layers.heights[k] > y.lo && layers.heights[k] < y.hi)) continue;
          bounds = {std::min(bounds.lo, layers.factors[k]), std::max(bounds.hi, layers.factors[k])};
        }
        return bounds;
      },
      [&](const ExponentialFall& fall) {
        return Interval{at(fall, y.hi), at(fall, y.lo)};
      });
}

std::vector<double> height_breaks(const HeightProfile& profile) {
  using Heights = std::vector<double>;
  return match(
      profile, [](const SameAtAllHeights&) { return Heights(); }, [](const Layers& layers) { return layers.heights; },
      [](const ExponentialFall& fall) { return Heights{fall.base}; });
}

Interval occupied_heights(const HeightProfile& profile) {
  return match(
      profile,
      [](const SameAtAllHeights&) {
        return Interval{-infinity, infinity};
      },
      [](const Layers& layers) {
        // Beyond a last factor of 0 there is nothing; before the first that is not, straight lines begin.
        const auto& f = layers.factors;
        std::size_t first = 0, last = f.size();
        while (first < last && f[first] == 0) ++first;
        while (last > first && f[last - 1] == 0) --last;
        if (first == last) return Interval{};
        return Interval{first == 0 ? -infinity : layers.heights[first - 1],
                        last == f.size() ? infinity : layers.heights[last]};
      },
      [](const ExponentialFall& fall) {
        return Interval{-infinity, fall.base + 39.2 * fall.scale_height};
      });
}

}  // namespace airlight::scene
