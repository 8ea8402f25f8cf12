#include "scene/convert/separable_gaussians.h"

#include <algorithm>

namespace airlight::scene::separable {

template <class T>
void Tables<T>::make(const SampleGaussian* gaussians, std::size_t n) {
  constexpr int lanes = Lanes<T>::count;
  parts_.resize(n);
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const SampleGaussian& g = gaussians[i];
    Part& p = parts_[i];
    p = {g.center, g.width * g.width, g.amplitude, {}, {}, at, 0};
    const double reach = std::sqrt(limit_) * g.width * (1 + 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      // Compared as doubles: a centre may be further away than an int can say.
      p.lo[axis] = int(std::clamp(std::ceil(g.center[axis] - reach), 0.0, double(layout_.size[axis])));
      p.hi[axis] = int(std::clamp(std::floor(g.center[axis] + reach), -1.0, layout_.size[axis] - 1.0));
    }
    if (g.amplitude == 0) p.hi[0] = p.lo[0] - 1;
    if (p.empty()) continue;
    p.width_in_blocks = p.hi[0] / lanes - p.lo[0] / lanes + 1;
    at += (moments_ ? 3 : 1) * p.width_in_blocks * lanes + (p.hi[1] - p.lo[1] + 1) + (p.hi[2] - p.lo[2] + 1);
    at = (at + lanes - 1) / lanes * lanes;
  }
  values_.resize(at);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, n, 16),
      [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const Part& p = parts_[i];
          if (p.empty()) continue;
          T* to = values_.data() + p.at;
          const int count = p.width_in_blocks * lanes, begin = p.first_block() * lanes;
          for (int k = 0; k < count; ++k) {
            const double d = begin + k - p.center[0], value = std::exp(-d * d / p.width2);
            // Beyond the reach no run goes; below the least normal number arithmetic would be slow.
            const double kept = d * d < 1.01 * limit_ * p.width2 ? value : 0;
            to[k] = T(kept);
            if (moments_) {
              const bool there = begin + k < layout_.size[0];
              to[count + k] = there ? T(d) : T(0);
              to[2 * count + k] = there ? T(d * d) : std::numeric_limits<T>::max();
            }
          }
          to += (moments_ ? 3 : 1) * count;
          for (int axis = 1; axis < 3; ++axis)
            for (int k = p.lo[axis]; k <= p.hi[axis]; ++k) {
              const double d = k - p.center[axis];
              *to++ = T(std::exp(-d * d / p.width2));
            }
        }
      },
      tbb::simple_partitioner());
}

template class Tables<float>;
template class Tables<double>;

}  // namespace airlight::scene::separable
