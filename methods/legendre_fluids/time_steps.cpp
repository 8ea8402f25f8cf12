#include "methods/legendre_fluids/time_steps.h"

namespace airlight::legendre_fluids {

Array runge_kutta_4(const Array& y, double dt, const std::function<Array(const Array&)>& rate) {
  const Array k1 = rate(y), k2 = rate(y + 0.5 * dt * k1), k3 = rate(y + 0.5 * dt * k2), k4 = rate(y + dt * k3);
  return y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

}  // namespace airlight::legendre_fluids
