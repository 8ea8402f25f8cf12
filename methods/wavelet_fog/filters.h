// Filters of B-spline wavelets: fine from coarse by c_i = sum_k p_{i-2k} a_k + q_{i-2k} d_k, and back by
// a_k = sum_i p~_{i-2k} c_i, d_k = sum_i q~_{i-2k} c_i. Giroud and Biri 2010, section 3.2; the paper lists no {q_k}.
#pragma once
#include <string>
#include <vector>

namespace airlight::wavelet_fog {

// A filter: values[0] belongs to index `first`.
struct Taps {
  int first = 0;
  std::vector<double> values;
};

struct Family {
  std::string name;
  int degree;  // of the splines
  Taps p, q, p_tilde, q_tilde;
};

// "haar" (degree 0); of Cohen, Daubechies and Feauveau 1992 "cdf22" (1), "cdf33" (2), and "cdf31" (2), whose iterated low-pass grows without end: for the table
// that shows it. Throws Error for another name.
const Family& family(const std::string& name);

// p_k = 2^-n C(n+1, k): any degree.
Taps two_scale(int degree);
// q of the wavelets orthogonal to all coarse splines (Chui and Wang), whose analysis filters never end.
Taps semi_orthogonal(int degree);
// p / 2 as analysis filter: keeps signs and the sum.
Taps restriction(int degree);

}  // namespace airlight::wavelet_fog
