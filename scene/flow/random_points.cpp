#include "scene/flow/random_points.h"

#include "scene/base/error.h"
#include "scene/math/random.h"

namespace airlight::scene {

Vec3 random_shares(std::uint32_t seed, std::size_t i, std::uint32_t times) {
  const PhiloxKey key{seed, 0x7074};
  const RandomBlock first{philox4x32_10({std::uint32_t(i), times, 0, 0}, key)};
  const RandomBlock second{philox4x32_10({std::uint32_t(i), times, 1, 0}, key)};
  return {first.fine(0), first.fine(1), second.fine(0)};
}

std::vector<Point3> random_points(const Region& region, const Box& box, std::size_t count, std::uint32_t seed) {
  constexpr std::uint32_t most_times = 10'000;
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t times = 0;
    for (; times < most_times; ++times) {
      const Point3 x = box.lo + box.size().cwiseProduct(random_shares(seed, i, times));
      if (!contains(region, x)) continue;
      points.push_back(x);
      break;
    }
    if (times == most_times) throw Error("particles: the region fills less than 1/10000 of the box around it");
  }
  return points;
}

}  // namespace airlight::scene
