// A Gaussian ball of smoke in an even environment, to 1e-7: moments of the light on spheres, polynomials of the radius in shells, and the
// transport equation integrated along chords between them (Nystroem's method). Lengths are in widths of the Gaussian.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace airlight::test {

struct BallLight {
  double extinction = 1;  // at the centre, times the width
  double cut = 3;         // radius of the ball
  double albedo = 0.9;
  std::vector<double> phase{1};  // mean of P_l over the phase function
  double environment = 1;        // radiance
};

class BallTransport {
 public:
  explicit BallTransport(const BallLight&);
  // At this distance from the centre: half the integral of P_l times radiance over the cosine to the radius.
  double moment(int l, double radius) const;
  double reduced_moment(int l, double radius) const;  // light that was not scattered
  // Radiance and transmittance of a ray where it leaves the ball. `impact`: distance at which it passes the centre.
  double exit_radiance(double impact) const;
  double exit_transmittance(double impact) const;

 private:
  // A place on a chord: distance of the chord from the centre, and the way from its middle, in the direction of the light.
  double depth_from_face(double impact, double along) const;
  // Contribution of each unknown (moment l at node i) to the radiance there.
  Eigen::RowVectorXd gathered(double impact, double along) const;
  // Contribution of each unknown to the moments at that distance from the centre: a row for each.
  Eigen::MatrixXd moment_rows(double radius) const;

  BallLight light_;
  int bands_;
  std::vector<double> edges_, node_;  // of shells; radii
  Eigen::MatrixXd interpolation_;     // in a shell, from values at its nodes to Legendre coefficients
  Eigen::VectorXd moments_;           // by node, then by band
};

}  // namespace airlight::test
