// Columns towards light from one direction, from points of a Legendre box: the integral of the density to the face
// where the light enters.
//
// To one face this column is a polynomial of the point: the integral of a polynomial of degree d over a
// length that is linear in the point. So three polynomials suffice, for the faces by which the light
// comes in, and the nearest face is the right one. Where the light grazes a face, the face's polynomial
// is large outside the part of the box where it is right, and digits cancel. Such a face is integrated
// by Gauss points instead, which is exact as well. Where the density is clamped there is no polynomial:
// then every point integrates the positive part of the density on its own path.
#pragma once
#include <array>
#include <vector>

#include "methods/legendre_fluids/point_values.h"
#include "scene/media/legendre_box.h"

namespace airlight::legendre_fluids {

class LightColumns {
 public:
  enum class Below { zero, as_it_is };  // what is below 0 of a density
  // The box outlives this. `to_light` is a unit vector of the world. A face keeps its polynomial where that is right to `rounding` [m].
  LightColumns(const scene::LegendreBox&, const Vec3& to_light, double rounding, Below = Below::zero);

  // Integral of the density from places of a ray to the light [m], `count` of them; the ray may be outside of the box. Between the first and
  // the last place the light comes in and goes out by the same faces (cuts).
  void along(const Ray&, const double* t, int count, double* columns) const;
  double at(const Point3& x) const;  // at one point of the world

  // Integrals for a density that is nowhere below 0, or that is not clamped: from points of the box to
  // the face of an axis by which the light enters, and over lengths towards the light [m]. Points are
  // lanes in the box's own coordinates.
  using LocalLanes = std::array<Lanes, 3>;
  Lanes to_face(int axis, const LocalLanes& local) const;
  Lanes over(const LocalLanes& local, const Lanes& length) const;

  // Ray parameters where the face changes by which light enters or leaves, ascending in no order: the planes that light and edges span.
  // With `inside` only of the edges that matter within the box.
  void cuts(const Ray&, bool inside, std::vector<double>&) const;

  int polynomials() const;                                              // faces that have one, 0 to 3
  int face_count() const { return int((rate_.array() != 0).count()); }  // that light comes in by
  // Coefficients of a polynomial, and its shape; empty where a face has none. For a backend that evaluates them itself.
  struct Face {
    scene::TensorShape shape{};
    Eigen::VectorXd coefficients;
  };
  const std::array<Face, 3>& faces() const { return face_; }
  const Vec3& rate() const { return rate_; }  // of the box's own coordinates, per metre towards the light

 private:
  int nearest_face(const Vec3& local) const;
  int first_face(const Vec3& local) const;
  double way_to(int axis, const Vec3& local, int side) const { return (side - local[axis]) / rate_[axis]; }
  Face polynomial(int axis, int along, double rounding) const;
  double rounding_of(const Face&, int axis) const;

  const scene::LegendreBox* box_;
  bool clamped_;  // what is integrated is no polynomial
  Vec3 to_light_, rate_;
  Eigen::Vector3i side_;               // -1 or 1: of the faces that the light comes in by
  std::vector<double> node_, weight_;  // on [0, 1], exact for the density on any line
  std::array<Face, 3> face_;
};

}  // namespace airlight::legendre_fluids
