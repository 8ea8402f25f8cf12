// Points of a region by counter-based random numbers.
#pragma once
#include <string_view>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/region.h"

namespace airlight::scene {

// Positions of particles in a CSV file: a row for each, in the order of their numbers; `set` is the number of their [[particles]].
inline constexpr std::string_view particle_header = "set,x,y,z";

// `count` points, even in the part of the region that lies in the (finite) box: pure functions of the seed and their number. Throws Error
// where fewer than one in 10^4 points of the box are in the region.
std::vector<Point3> random_points(const Region&, const Box&, std::size_t count, std::uint32_t seed);

// The numbers behind them: three in (0, 1), of particle `i`, drawn for the `times`-th time.
Vec3 random_shares(std::uint32_t seed, std::size_t i, std::uint32_t times);

}  // namespace airlight::scene
