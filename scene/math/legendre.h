// The orthonormal Legendre basis on [-1, 1] and its tensor products on [-1, 1]^d: matrices, points and coefficients.
//
//   L_k(x) = sqrt((2k+1)/2) P_k(x),   f(x, y, z) = sum F[i][j][k] L_i(x) L_j(y) L_k(z)
//
// Arrays of coefficients, or of values on a lattice, are flat with index order [x][y][z], z fastest: entry (i, j, k) of a shape (a, b, c)
// is at (i b + j) c + k. A field in two dimensions has c = 1, in one b = c = 1; along an axis that is absent the matrix is 1 x 1, one.
// Gupta and Narasimhan 2007, section 4.
#pragma once
#include <Eigen/Core>
#include <array>

namespace airlight::scene {

// Column i holds the coefficients of L_i': those of f' are D F. n x n (equation 9, transposed: the paper prints D^T).
Eigen::MatrixXd legendre_derivative(int n);

// Column i holds the coefficients of the integral of L_i from -1: (n+1) x n. Its columns 1.. are functions that vanish at both ends.
Eigen::MatrixXd legendre_integral(int n);

// The integral of L_i L_j L_k over [-1, 1]; 0 for odd i + j + k and outside the triangle rule. Indices up to 200 (equation 10).
double legendre_triple(int i, int j, int k);

// Coefficients of a product, 2n-1 of them, to n: converted to Chebyshev, cut, converted back; n x (2n-1). It leaves degrees below n as they
// are. Half the maximum error of cutting Legendre coefficients, but it changes the mean (section 4.2).
Eigen::MatrixXd chebyshev_truncation(int n);

// L_0(x) to L_{n-1}(x), and their slopes, at any points: points x n. |x| may exceed 1.
Eigen::MatrixXd legendre_values(int n, const Eigen::VectorXd& x);
Eigen::MatrixXd legendre_slopes(int n, const Eigen::VectorXd& x);
// At one point, into n numbers.
void legendre_values_at(int n, double x, double* values);

// Between n coefficients and values at m Gauss points of an axis. `values` is exact; `analysis` is exact for polynomials of a degree up to
// 2m - n (n - 1 of them are those that come back from their own values where m >= n).
struct LegendrePoints {
  LegendrePoints(int n, int m);    // n, m >= 1
  Eigen::VectorXd node, weight;    // m, ascending in (-1, 1); weights add up to 2
  Eigen::MatrixXd values, slopes;  // m x n: times coefficients
  Eigen::MatrixXd analysis;        // n x m: times values, the L2 projection by quadrature
};

// Made when first asked for and kept; n alone: n = m, below 256. Thread safe.
const LegendrePoints& legendre_points(int n);
const LegendrePoints& legendre_points(int n, int m);

// Number of entries along x, y, z.
using TensorShape = std::array<int, 3>;
inline int tensor_size(const TensorShape& shape) { return shape[0] * shape[1] * shape[2]; }

// The array with `matrix` (p x shape[axis]) applied along one axis; its shape along that axis becomes p.
Eigen::VectorXd along_axis(int axis, const Eigen::MatrixXd& matrix, const Eigen::VectorXd& array,
                           const TensorShape& shape);
// Along all three.
Eigen::VectorXd along_axes(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Eigen::MatrixXd& z,
                           const Eigen::VectorXd& array, const TensorShape& shape);

// The product of two fields, its first `kept` coefficients along every axis: all of them for f + g - 1, else their L2 projection (Galerkin
// product). Axes from `dimensions` on are absent (length 1, no L_0).
Eigen::VectorXd legendre_product(const Eigen::VectorXd& f, const TensorShape& f_shape, const Eigen::VectorXd& g,
                                 const TensorShape& g_shape, const TensorShape& kept, int dimensions = 3);

}  // namespace airlight::scene
