#include "experiments/verify/legendre_vectors.h"

#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::experiments::verification {

Tensor tensor_from(const Value& v) {
  Tensor tensor;
  std::vector<double> values;
  tensor.shape[0] = int(v.size());
  if (tensor.shape[0] < 1) v.complain("a list of coefficients");
  const auto same = [](int& length, const Value& list, bool first) {
    if (first) length = int(list.size());
    if (int(list.size()) != length || length < 1) list.complain(fmt::format("{} entries, as in the first", length));
  };
  for (int i = 0; i < tensor.shape[0]; ++i) {
    const Value plane = v[std::size_t(i)];
    if (!plane.is_array()) {
      values.push_back(plane.number());
      continue;
    }
    same(tensor.shape[1], plane, i == 0);
    for (int j = 0; j < tensor.shape[1]; ++j) {
      const Value row = plane[std::size_t(j)];
      if (!row.is_array()) {
        values.push_back(row.number());
        continue;
      }
      same(tensor.shape[2], row, i == 0 && j == 0);
      for (const double c : row.numbers()) values.push_back(c);
    }
  }
  if (int(values.size()) != scene::tensor_size(tensor.shape)) v.complain("lists of the same lengths");
  tensor.values = Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  return tensor;
}

std::vector<Comparison> largest_differences(const std::string& name, const Eigen::VectorXd& expected,
                                            const Eigen::VectorXd& got, double tolerance) {
  if (expected.size() != got.size())
    throw Error(fmt::format("{}: found {} numbers, expected {}", name, expected.size(), got.size()));
  Eigen::Index worst = 0;
  (expected - got).cwiseAbs().maxCoeff(&worst);
  const double scale = expected.cwiseAbs().maxCoeff();
  Comparison c = absolute(fmt::format("{} (entry {})", name, worst), expected[worst], got[worst], tolerance * scale);
  c.tolerance_text = fmt::format("{:.0e} of the largest", tolerance);
  return {c};
}

}  // namespace airlight::experiments::verification
