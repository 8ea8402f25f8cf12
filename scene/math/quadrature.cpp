#include "scene/math/quadrature.h"

namespace airlight::scene {

// Nodes are roots of Legendre and Stieltjes polynomials, weights from the moments, computed with 60 digits.
const KronrodRule& kronrod7() {
  static const KronrodRule rule{
      4,
      {0, 0.434243749346802558, 0.77459666924148337704, 0.96049126870802028342},
      {0.45091653865847414235, 0.40139741477596222291, 0.26848808986833344073, 0.10465622602646726519},
      {0.88888888888888888889, 0, 0.55555555555555555556, 0}};
  return rule;
}

const KronrodRule& kronrod15() {
  static const KronrodRule rule{
      8,
      {0, 0.2077849550078984676, 0.40584515137739716691, 0.58608723546769113029, 0.74153118559939443986,
       0.86486442335976907279, 0.94910791234275852453, 0.99145537112081263921},
      {0.20948214108472782801, 0.20443294007529889241, 0.19035057806478540991, 0.16900472663926790283,
       0.14065325971552591875, 0.10479001032225018384, 0.063092092629978553291, 0.022935322010529224964},
      {0.41795918367346938776, 0, 0.38183005050511894495, 0, 0.2797053914892766679, 0, 0.12948496616886969327, 0}};
  return rule;
}

bool within_tolerance(const Rgb& value, const Rgb& error, const QuadratureOptions& options) {
  for (int c = 0; c < 3; ++c) {
    const double allowed =
        std::max(options.absolute_tolerance[c], std::max(options.relative_tolerance, 1e-15) * std::abs(value[c]));
    if (!(error[c] <= allowed)) return false;
  }
  return true;
}

EquiangularMap::EquiangularMap(double xa, double xb, double h)
    : near_(std::abs(xa)), far_(std::abs(xb)), h_(h), sign_(xa + xb < 0 ? -1 : 1), reversed_(false) {
  if (near_ > far_) {
    std::swap(near_, far_);
    reversed_ = true;  // u runs from the far end to the near one
  }
  if (h_ > 0) {
    // tan(angle) = h (far - near) / (h^2 + near far), without subtracting angles.
    angle_ = std::isinf(far_) ? std::atan2(h_, near_) : std::atan2(h_ * (far_ - near_), h_ * h_ + near_ * far_);
    density_ = angle_ / h_;
  } else {
    density_ = std::isinf(far_) ? 1 / near_ : (far_ - near_) / (near_ * far_);
    angle_ = 0;
  }
}

double EquiangularMap::x(double u) const {
  const double s = reversed_ ? 1 - u : u;
  const double turn = h_ > 0 ? std::tan(s * angle_) / h_ : s * density_;
  // Rounding must not carry a node past the ends.
  const double distance = (near_ + h_ * h_ * turn) / (1 - near_ * turn);
  return sign_ *
         (distance >= near_ && distance <= far_ ? distance : (distance < near_ && distance >= 0 ? near_ : far_));
}

}  // namespace airlight::scene
