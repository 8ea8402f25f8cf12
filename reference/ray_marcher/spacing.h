// Where a camera ray is sampled: its steps.
//
// The ray is cut where it enters or leaves a region or the support of a field, so that the density is smooth between
// the cuts and the midpoint rule keeps its order. `uniform` gives all parts steps of one length. `graded` departs from
// that where equal steps are hopeless:
//   around a point or spot light at distance h from the ray, x = h u / (1 - u^2)^3 along the ray with equal steps in u:
//   they grow as |x|^(4/3), which spreads the midpoint rule's error on 1/(h^2 + x^2) evenly, out to where they have
//   grown to the length of the others; where a constant medium with extinction k goes on for ever, steps grow as exp(k
//   t / 2) behind the light; parts of the ray where the medium is constant get no more steps than those where it
//   varies.
// A ray without an end is cut at the optical depth `horizon`, or farther on where every way from each lamp over the ray
// to the eye is `horizon` deeper than the straight one: the whole picture of a lamp 30 depths away is as dark as e^-30,
// and most of that comes from the lamp's neighbourhood, because of the inverse square.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "reference/ray_marcher/layer.h"
#include "reference/ray_marcher/options.h"

namespace airlight::ray_marcher {

// One step [t - length/2, t + length/2] of a ray. Bit 2k of `inside`: in the region of layer k (which has a constant);
// bit 2k+1: in its varying part.
struct Step {
  double t;
  double length;
  unsigned long long inside;
};
constexpr std::size_t most_layers = 32;
inline bool in_constant(unsigned long long inside, std::size_t layer) { return inside >> (2 * layer) & 1; }
inline bool in_varied(unsigned long long inside, std::size_t layer) { return inside >> (2 * layer + 1) & 1; }

// Steps [begin, end) of an array, in order of t.
struct Spacing {
  std::size_t begin = 0, end = 0;
  // Per channel: true where the medium behind the last step goes on for ever, so that nothing beyond it is seen.
  Eigen::Array<bool, 3, 1> endless = Eigen::Array<bool, 3, 1>::Constant(false);
  bool around_light = false;  // graded around the light: different from what it is without the light
  // Behind so much optical depth nothing matters beside what lies before it, unless a lamp is as deep in an endless
  // medium; never more than single precision can hold.
  double deepest = 40;
};

// Distance of the ray from a light, and where along the ray it is reached.
struct Approach {
  double t;
  double h;
};
Approach approach(const Ray&, const Point3& light);

// Mean of 1/distance^2 to the light over a step [1/m^2], in closed form: the angle under which the light sees the step
// over h * length. It makes the inverse square exact in a step.
double mean_inverse_square(const Approach&, const Step&);

// Appends the steps of the ray over [0, t_end], for `lamps`, the point and spot lights that they serve; `light`: grade
// around it too. With Options::skip_empty, equal steps whose midpoint lies in an empty brick of every grid that is
// there are left out; the others are where they would be.
Spacing make_spacing(const std::vector<Layer>&, const Options&, const Ray&, double t_end,
                     std::span<const Approach> lamps, const std::optional<Approach>& light, std::vector<Step>& steps);

// How far beyond the ray's point at `from` a way from the lamp to that point turns that is `longer` than the straight
// one [m]: t + d(t) = d(0) + longer, without a difference of lengths.
double beyond_lamp(const Approach&, double from, double longer);

}  // namespace airlight::ray_marcher
