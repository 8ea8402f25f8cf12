// A Legendre box along a ray: there its density is a polynomial too, of a degree up to the sum of the three, clamped at 0.
//
// It is expanded in the Legendre basis of the ray's own range, exactly, by as many Gauss points as it has coefficients. Its sign changes
// are isolated by halving until the range (legendre_range, rigorous) of a half has one sign, or that of its slope has, which leaves
// one root to bisect; what is positive is integrated in closed form. Not looked at closer: pieces whose integral is below rounding.
#pragma once
#include <vector>

#include "scene/media/legendre_box.h"

namespace airlight::scene {

class LegendreLine {
 public:
  // t lies within the box, and is not empty [m].
  LegendreLine(const LegendreBox&, const Ray&, Interval t);

  double density(double t) const;   // clamped; t within the range
  double integral(double t) const;  // from the range's begin to t [m]
  // Where it is positive, ascending; the rest of the range is empty.
  const std::vector<Interval>& positive() const { return positive_; }

 private:
  double to_local(double t) const { return ((t - range_.lo) - (range_.hi - t)) / range_.length(); }
  double primitive(double t) const;  // of the polynomial [m]
  void isolate(const Eigen::VectorXd& series, Interval t);
  void add(Interval t);

  Interval range_;
  Eigen::VectorXd series_, primitive_;
  double rounding_;  // of a value
  std::vector<Interval> positive_;
  std::vector<double> before_;  // integral up to the begin of each
};

}  // namespace airlight::scene
