#include "methods/legendre_fluids/paper_light.h"

#include <cmath>

namespace airlight::legendre_fluids {

scene::TensorShape intensity_shape(const scene::TensorShape& density, int n, const std::array<bool, 3>& moving) {
  scene::TensorShape shape;
  for (std::size_t a = 0; a < 3; ++a) shape[a] = density[a] == 1 && !moving[a] ? 1 : n;
  return shape;
}

PaperLight::PaperLight(const scene::LegendreBox& box, const PaperOptions& options, const std::array<bool, 3>& moving)
    : box_(&box),
      options_(options),
      product_(box.coefficients(), box.shape(), intensity_shape(box.shape(), options.n, moving), options.truncation) {}

Eigen::VectorXd PaperLight::direct(const Vec3& direction, double sigma, int* iterations) const {
  const LightSystem system(product_, rate(direction), sigma, options_.solver);
  return system.solve(Eigen::VectorXd::Zero(scene::tensor_size(shape())), 1, iterations);
}

Eigen::VectorXd PaperLight::scattered(const Eigen::VectorXd& direct, const Vec3& direction, double sigma,
                                      double scattering, int* iterations) const {
  const LightSystem system(product_, rate(direction), sigma, options_.solver);
  return system.solve(scattering * product_(direct), 0, iterations);
}

Eigen::VectorXd PaperLight::on_face(const Eigen::VectorXd& coefficients, int axis, int side) const {
  const int n = shape()[std::size_t(axis)];
  const Eigen::MatrixXd end = scene::legendre_values(n, Eigen::VectorXd::Constant(1, side)) * std::sqrt(2.0);
  return scene::along_axis(axis, end, coefficients, shape());
}

}  // namespace airlight::legendre_fluids
