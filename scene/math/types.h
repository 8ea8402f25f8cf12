// Points, directions, colours, rays and boxes: the words of every other header.
//
// World: right-handed, +y up, metres, radians. Colours: linear RGB, Rec. 709 primaries. All in double precision.
#pragma once
#include <Eigen/Core>
#include <limits>

namespace airlight {

using Vec3 = Eigen::Vector3d;
using Point3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Rgb = Eigen::Array3d;  // one value per colour channel

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double pi = 3.14159265358979323846;

struct Ray {
  Point3 origin;
  Vec3 direction;  // unit length
  Point3 at(double t) const { return origin + t * direction; }
};

// A closed range [lo, hi] of ray parameters or of values; empty when lo > hi (for rays: when lo >= hi).
struct Interval {
  double lo = infinity;
  double hi = -infinity;
  bool empty() const { return !(lo < hi); }
  double length() const { return empty() ? 0 : hi - lo; }
};

inline Interval intersect(Interval a, Interval b) { return {a.lo > b.lo ? a.lo : b.lo, a.hi < b.hi ? a.hi : b.hi}; }

// An axis-aligned box, closed.
struct Box {
  Point3 lo = Point3::Constant(infinity);
  Point3 hi = Point3::Constant(-infinity);
  bool empty() const { return !(lo.array() <= hi.array()).all(); }
  Point3 center() const { return 0.5 * (lo + hi); }
  Vec3 size() const { return hi - lo; }
  bool contains(const Point3& x) const { return (x.array() >= lo.array()).all() && (x.array() <= hi.array()).all(); }
};

inline Box unite(const Box& a, const Box& b) { return {a.lo.cwiseMin(b.lo), a.hi.cwiseMax(b.hi)}; }
inline Box intersect(const Box& a, const Box& b) { return {a.lo.cwiseMax(b.lo), a.hi.cwiseMin(b.hi)}; }

// Rec. 709 luminance of a linear colour.
inline double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

}  // namespace airlight
