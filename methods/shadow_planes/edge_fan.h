// Which silhouette edges a ray may cross, by the angle around a line through the light. Not in the paper.
//
// All rays from a camera, and all parallel rays, lie with the light in planes through one line: the line from the light
// to the camera, or along the rays. An occluder that shades a point of a ray lies in the same half of such a plane. So
// an edge is met only by rays whose angle around the line is between those of the edge's ends, and is kept in a few of
// the sectors of that size.
#pragma once
#include <vector>

#include "methods/shadow_planes/shadow_volumes.h"
#include "scene/camera.h"

namespace airlight::shadow_planes {

// Unit vectors across the line.
struct FanAxes {
  Vec3 x, y;
};
FanAxes fan_axes(const scene::Camera&, const Point3& light);

class EdgeFan {
 public:
  EdgeFan(const ShadowVolumes&, const scene::Camera&);

  // Every edge that the ray may cross, and some more; in no order.
  void of_ray(const Ray&, std::vector<int>& edges) const;

  static constexpr int levels = 8;  // of 4, 16, ... 65536 sectors
  static constexpr int total_sectors() { return first_sector(levels); }
  // `margin`: widening of angular ranges, where a whole turn is 4. It exceeds the rounding of angles for vectors with a
  // share of more than `least_across` across the line. Other vectors are met by all rays, or meet all edges.
  static constexpr double margin = 1e-8, least_across = 1e-6;

 private:
  static constexpr int sectors(int level) { return 4 << (2 * level); }
  static constexpr int first_sector(int level) { return (sectors(level) - 4) / 3; }
  struct Range {
    int level, first, last;  // sectors; the last may be past the end, to go on at the beginning
  };
  Range range_of(const SilhouetteEdge&) const;
  double turn(const Vec3&) const;

  const ShadowVolumes& shadows_;
  bool perspective_;
  Vec3 x_, y_;
  std::vector<int> starts_;  // in edges_, by level and sector, and the end
  std::vector<int> edges_;
};

}  // namespace airlight::shadow_planes
