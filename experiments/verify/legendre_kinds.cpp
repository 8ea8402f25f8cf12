// Gupta and Narasimhan 2007: the Legendre basis. Matrices, triple products, products of fields and their truncation.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "experiments/verify/legendre_vectors.h"
#include "experiments/verify/readers.h"
#include "scene/math/dense.h"
#include "scene/math/legendre.h"

namespace airlight::experiments::verification {
namespace {

using scene::TensorShape;

constexpr double gate = 1e-12;  // of the vectors: relative to the largest entry

Check compare_matrices(const std::string& name, const Value& v, const Eigen::MatrixXd& got) {
  const Tensor expected = tensor_from(v);
  if (expected.shape[0] != got.rows() || expected.shape[1] != got.cols())
    v.complain(fmt::format("a matrix of {} x {}", got.rows(), got.cols()));
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Rows rows = got;
  const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXd>(rows.data(), rows.size());
  return {"", [=](VerifyProfile) { return Outcome{largest_differences(name, expected.values, flat, gate)}; }};
}

// One comparison for each entry of a list; `value` is the expected number's field.
template <class Got>
Check compare_entries(const Value& v, const char* value, double tolerance, Got&& got) {
  std::vector<Comparison> comparisons;
  const Value entries = v["entries"];
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto [name, number] = got(entries[e]);
    const double expected = entries[e][value].number();
    comparisons.push_back(relative(name, expected, number, tolerance, tolerance));
  }
  return {"", [=](VerifyProfile) { return Outcome{comparisons}; }};
}

int index_of(const Value& entry, const char* name) { return entry[name].integer_in(0, 200); }

}  // namespace

Check read_legendre_derivative(const Value& v) {
  return compare_matrices("D", v["D[k][i]"], scene::legendre_derivative(v["n"].integer_in(1, 200)));
}

Check read_legendre_integral(const Value& v) {
  return compare_matrices("B", v["B[k][i]"], scene::legendre_integral(v["n"].integer_in(1, 200)));
}

Check read_legendre_derivative_samples(const Value& v) {
  return compare_entries(v, "c", gate, [](const Value& e) {
    const int i = index_of(e, "i"), k = index_of(e, "k");
    return std::pair(fmt::format("D {} {}", k, i), scene::legendre_derivative(std::max(i, k) + 1)(k, i));
  });
}

Check read_legendre_integral_samples(const Value& v) {
  return compare_entries(v, "b", gate, [](const Value& e) {
    const int i = index_of(e, "i"), k = index_of(e, "k");
    return std::pair(fmt::format("B {} {}", k, i), scene::legendre_integral(std::max(i, k) + 1)(k, i));
  });
}

Check read_legendre_triple(const Value& v) {
  return compare_entries(v, "TI", gate, [](const Value& e) {
    const int i = index_of(e, "i"), j = index_of(e, "j"), k = index_of(e, "k");
    return std::pair(fmt::format("{} {} {}", i, j, k), scene::legendre_triple(i, j, k));
  });
}

Check read_legendre_triple_count(const Value& v) {
  return compare_entries(v, "nonzero", 0, [](const Value& e) {
    const int n = e["n"].integer_in(1, 64);
    int nonzero = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) nonzero += scene::legendre_triple(i, j, k) != 0;
    return std::pair(fmt::format("n = {}", n), double(nonzero));
  });
}

Check read_legendre_truncation(const Value& v) {
  return compare_matrices("T", v["T"], scene::chebyshev_truncation(v["n"].integer_in(1, 64)));
}

Check read_legendre_phi_mass(const Value& v) {
  const int n = v["n"].integer_in(2, 64);
  const Eigen::MatrixXd phi = scene::legendre_integral(n).rightCols(n - 1), mass = phi.transpose() * phi;
  const Check matrix = compare_matrices("M", v["M"], mass);
  const std::vector<double> expected = v["eigenvalues"].numbers();
  if (int(expected.size()) != n - 1) v["eigenvalues"].complain(fmt::format("{} numbers", n - 1));
  return {"", [=](VerifyProfile profile) {
            Outcome out = matrix.job(profile);
            const Eigen::VectorXd got = scene::symmetric_modes(mass).values;
            for (int i = 0; i < n - 1; ++i)
              out.add(relative(fmt::format("eigenvalue {}", i), expected[std::size_t(i)], got[i], gate));
            return out;
          }};
}

Check read_legendre_product(const Value& v) {
  const int d = v["d"].integer_in(1, 3);
  const Tensor f = tensor_from(v["F"]), g = tensor_from(v["G"]), cut = tensor_from(v["H_trunc_cheb"]);
  if (f.shape != g.shape || f.shape != cut.shape) v.complain("F, G and H_trunc_cheb of the same shape");
  TensorShape full = f.shape;
  for (std::size_t axis = 0; axis < std::size_t(d); ++axis) full[axis] = 2 * full[axis] - 1;
  std::optional<Tensor> whole, projected;
  if (v.has("H")) whole = tensor_from(v["H"]);
  if (v.has("H_trunc_l2")) projected = tensor_from(v["H_trunc_l2"]);
  if ((whole && whole->shape != full) || (projected && projected->shape != f.shape))
    v.complain("H of 2n-1 per axis, H_trunc_l2 of n");
  return {"", [=](VerifyProfile) {
            const Eigen::VectorXd h = scene::legendre_product(f.values, f.shape, g.values, g.shape, full, d);
            std::array<Eigen::MatrixXd, 3> t;
            for (std::size_t axis = 0; axis < 3; ++axis)
              t[axis] = int(axis) < d ? scene::chebyshev_truncation(f.shape[axis]) : Eigen::MatrixXd::Ones(1, 1);
            Outcome out;
            const auto add = [&](const char* name, const Eigen::VectorXd& expected, const Eigen::VectorXd& got) {
              for (const Comparison& c : largest_differences(name, expected, got, gate)) out.add(c);
            };
            if (whole) add("H", whole->values, h);
            add("H_trunc_cheb", cut.values, scene::along_axes(t[0], t[1], t[2], h, full));
            if (projected)
              add("H_trunc_l2", projected->values,
                  scene::legendre_product(f.values, f.shape, g.values, g.shape, f.shape, d));
            return out;
          }};
}

}  // namespace airlight::experiments::verification
