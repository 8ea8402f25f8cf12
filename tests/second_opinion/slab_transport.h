// Slabs under even light, to rounding: directions by Gauss quadrature that is dense along the faces, the modes of the equation exact in
// depth (Chandrasekhar 1950; Stamnes et al. 1988), radiance in between by the integral of its source. Depth is optical.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace airlight::test {

struct SlabLight {
  double thickness = 1;          // > 0
  double albedo = 0.9;           // below 1
  std::vector<double> phase{1};  // mean of P_l over the phase function, g^l for Henyey-Greenstein
  double top = 1, bottom = 0;    // radiance that comes in, from all directions alike
  double emission = 0;           // isotropic source radiance everywhere
};

class SlabTransport {
 public:
  explicit SlabTransport(const SlabLight&, int directions = 100);  // on either side

  // Light that was scattered and light that was not. mu > 0 goes from top to bottom.
  double mean(double depth) const;
  double radiance(double depth, double mu) const;
  double flux_leaving(bool top) const;
  // Moment l of the light that nothing has scattered: half the integral of P_l times it.
  double reduced_moment(int l, double depth) const;

 private:
  Eigen::VectorXd sums(double depth) const;         // of opposite directions
  Eigen::VectorXd differences(double depth) const;  // down less up
  // Integral over t < depth of source moments times exp(-(depth - t) / mu) / mu, towards larger depths in a slab turned over or not.
  double gathered(double depth, double mu, bool turned) const;

  SlabLight light_;
  Eigen::VectorXd mu_, weight_, rate_;
  Eigen::MatrixXd sum_, difference_;   // of a mode; of a growing one the difference has the other sign
  Eigen::MatrixXd moments_;            // by band, of a mode
  Eigen::VectorXd falling_, growing_;  // shares of exp(-k depth), and of exp(-k (thickness - depth))
  double even_ = 0;                    // sum of opposite directions that the emission makes far from the faces
};

// Chandrasekhar's H(mu) of isotropic scattering, at the nodes of a rule on [0, 1] and anywhere.
class HFunction {
 public:
  explicit HFunction(double albedo, int nodes = 128);
  double operator()(double mu) const;
  double first_moment() const;  // integral of mu H

 private:
  double albedo_;
  std::vector<double> node_, weight_, value_;
};

}  // namespace airlight::test
