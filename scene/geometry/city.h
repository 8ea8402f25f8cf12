// A city of boxes on a grid of streets.
#pragma once
#include <cstdint>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// Box n stands on lot (n mod columns, n / columns); lots are `lot` wide, and a street of width `street` follows every
// `block` lots on both axes. Footprints take 0.7 to 0.95 of a lot. Heights lie between the two given, few are high;
// they sink away from the middle of the grid. Random numbers are functions of (seed, n). 24 vertices a box: each side
// has its own four.
struct City {
  Point3 origin = Point3::Zero();  // the corner of lot (0, 0), on the ground
  int boxes = 100;                 // 1 to 100000
  int columns = 10;                // 1 to 10000
  int block = 3;                   // lots, >= 1
  double lot = 10;                 // [m], > 0
  double street = 10;              // [m], >= 0
  double least_height = 5;         // [m], > 0
  double greatest_height = 50;     // [m], >= least_height
  std::uint32_t seed = 0;
};
// Throws Error for values out of range.
TriangleMesh make_city(const City&);

// Where lot i begins, along either axis from the origin [m].
inline double lot_begin(const City& city, int i) { return i * city.lot + (i / city.block) * city.street; }

}  // namespace airlight::scene
