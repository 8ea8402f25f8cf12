// Arrays of the tile path: points with what belongs to them.
#pragma once
#include <numeric>
#include <vector>

#include "reference/ray_marcher/kernels.h"
#include "reference/ray_marcher/plan.h"

namespace airlight::ray_marcher {

// Grows to the padded size; never shrinks its memory.
template <class T>
void resize_padded(std::vector<T>& v, std::size_t n) {
  v.resize(padded(n));
}

template <class T>
void gather(const std::vector<T>& from, const std::vector<int>& index, std::vector<T>& to) {
  resize_padded(to, index.size());
  for (std::size_t i = 0; i < index.size(); ++i) to[i] = from[index[i]];
}

// Points in double, world.
struct Points {
  std::vector<double> x, y, z;
  void resize(std::size_t n) { resize_padded(x, n), resize_padded(y, n), resize_padded(z, n); }
  void set(std::size_t i, const Vec3& p) { x[i] = p[0], y[i] = p[1], z[i] = p[2]; }
  Point3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void select(const Points& from, const std::vector<int>& index) {
    gather(from.x, index, x), gather(from.y, index, y), gather(from.z, index, z);
  }
};

// Steps of a tile.
struct StepArrays {
  Points at, direction;  // midpoint; direction of the camera ray
  std::vector<float> length;
  // [layer * channels + channel of the transport]: weight * sigma_t * density, what the step scatters per unit of phase
  // function and irradiance
  std::vector<std::vector<float>> amount;

  void resize(std::size_t n) { at.resize(n), direction.resize(n), resize_padded(length, n); }
  void select(const StepArrays& from, const std::vector<int>& index) {
    at.select(from.at, index);
    direction.select(from.direction, index);
    gather(from.length, index, length);
    amount.resize(from.amount.size());
    for (std::size_t a = 0; a < amount.size(); ++a) gather(from.amount[a], index, amount[a]);
  }
};

// Light that reaches points from one lamp.
struct Arrivals {
  std::vector<float> to_x, to_y, to_z, distance, minus, plus, strength;
  void resize(std::size_t n) {
    for (auto* v : {&to_x, &to_y, &to_z, &distance, &minus, &plus, &strength}) resize_padded(*v, n);
  }
  void select(const Arrivals& from, const std::vector<int>& index) {
    gather(from.to_x, index, to_x), gather(from.to_y, index, to_y), gather(from.to_z, index, to_z);
    gather(from.distance, index, distance), gather(from.strength, index, strength);
    gather(from.minus, index, minus), gather(from.plus, index, plus);
  }
  Incidence view() {
    return {to_x.data(), to_y.data(), to_z.data(), distance.data(), minus.data(), plus.data(), strength.data()};
  }
};

// Integrals of every layer's density from points towards a light; scratch arrays kept between calls.
class Columns {
 public:
  // After this, column(k)[i] is the column of layer k from point i [m]. With shadow = map that is the column of constants
  // alone, and the light's map has the rest.
  void march(const Plan&, std::size_t light, std::size_t n, const Points&, const Arrivals&, Counters&);
  const std::vector<float>& column(std::size_t layer) const { return columns_[layer]; }
  // Optical depths from the light's map by channel of the transport [-]; null without one.
  const float* const* mapped() const { return mapped_ ? depths_ : nullptr; }

 private:
  void march_deep(const Plan&, const Layer&, std::size_t n, const Points&, const Arrivals&, std::vector<float>& column,
                  Counters&);
  void look_up(const light_map::LightMap&, std::size_t n, const Points&);
  std::vector<std::vector<float>> columns_;
  std::vector<float> depth_[3];
  const float* depths_[3] = {};
  bool mapped_ = false;
  std::vector<float> ox_, oy_, oz_, dx_, dy_, dz_, t0_, t1_;
};

}  // namespace airlight::ray_marcher
