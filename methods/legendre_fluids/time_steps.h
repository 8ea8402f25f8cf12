// Steps of y' = f(y): y may be a velocity, a scalar, or both one after the other.
#pragma once
#include <functional>

#include "methods/legendre_fluids/confined_space.h"

namespace airlight::legendre_fluids {

Array runge_kutta_4(const Array& y, double dt, const std::function<Array(const Array&)>& rate);

}  // namespace airlight::legendre_fluids
