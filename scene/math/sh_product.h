// Products of functions in real spherical harmonics: Zhou et al. 2007, Eq. 20 and section 4.3, after Snyder 2006.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// G_ijk = integral over the sphere of y_i y_j y_k where it is not 0, for i, j, k < order^2: symmetric in its indices,
// G_0jk = delta_jk / sqrt(4 pi). Exact quadrature of polynomials, error 1e-15.
class TripleProduct {
 public:
  struct Term {
    int i, j, k;
    double value;
  };
  explicit TripleProduct(int order);  // 1 to 12; Throws Error

  // The product f h, each given by order^2 coefficients, projected on as many: its inner product with a third function
  // is the integral of all three.
  std::vector<Rgb> operator()(const std::vector<Rgb>& f, const std::vector<double>& h) const;
  std::vector<double> operator()(const std::vector<double>& f, const std::vector<double>& h) const;

  const std::vector<Term>& terms() const { return terms_; }  // i <= j <= k
  int order() const { return order_; }

 private:
  int order_;
  std::vector<Term> terms_;
};

// The triple product of this order. Computed on first use and cached; thread-safe.
const TripleProduct& triple_product(int order);

}  // namespace airlight::scene
