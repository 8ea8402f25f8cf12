// Optical depth of the Gaussians from a light to every point around it, tabulated: directions on a square map,
// distances by edges, linear in between. The map is octahedral around a light in the midst of the Gaussians, and a
// perspective view of them from a light that sees them within 70 degrees of one direction.
#pragma once
#include <vector>

#include "methods/fogshop/kernels.h"
#include "scene/renderer.h"

namespace airlight::fogshop {

// Where the Gaussians lie as the light sees them.
struct MapFrame {
  double near = 0, far = 0;      // the Gaussians lie between these distances [m]
  double tangent = 0;            // half the width of the perspective view at distance 1; 0: octahedral
  Mat3 axes = Mat3::Identity();  // of the view in its rows, its direction last
};
MapFrame frame_of(const GaussianArrays&, const Point3& light);

// Where the texels and the edges of a map lie.
struct MapGrid {
  MapFrame frame;
  int directions = 0, edges = 0;

  Vec3 direction(int i, int j) const;  // of a texel; i, j from -1 to directions: a border of one texel
  double distance_of(double edge) const;
  // The four texels around a direction: i, j to i + 1, j + 1, counted from the border, and the share of the latter.
  struct Place {
    bool seen;
    int i, j;
    double fu, fv;
  };
  Place place(const Vec3& direction) const;
};

class LightMap {
 public:
  // `directions` squared texels and `edges` + 1 distances; every texel holds exact depths at its centre. Calls of the
  // error function are counted in `evaluations`.
  LightMap(const GaussianArrays&, const Point3& light, int directions, int edges, Erf, const scene::Execution&);

  // Depths between the light and the points at parameters t of a ray [-], for an extinction ratio of 1, without the constant term;
  // `t` and `depth` hold a multiple of 8 values.
  void depths(const Line& ray, const double* t, int count, double* depth) const;

  // At one point.
  double depth(const Point3& x) const;

  double evaluations() const { return evaluations_; }
  std::size_t bytes() const { return depths_.size() * sizeof(float); }

 private:
  Point3 light_;
  MapGrid grid_;
  std::vector<float> depths_;  // [row][column][edge], with a border of one texel
  double evaluations_ = 0;
};

}  // namespace airlight::fogshop
