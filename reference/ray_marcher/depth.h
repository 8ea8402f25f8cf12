// Steps that follow the optical depth, where equal ones would be too long for a thick medium.
//
// On camera rays a step deeper than `most_whole` * `deepest_step` is divided into ones of `deepest_step` at most, while
// less than Spacing::deepest lies before it (exp(-40) of the light is not missed); on shadow rays no step is deeper
// than `deepest_shadow_step` where the extinction at the ray's beginning makes the first one so. Longer ones are
// halved, and again, front to back; a step counts as deep by the greatest extinction of its ends and its middle. Both
// limits are the optical depth `horizon` shared among as many steps as are asked for, so that twice the steps are half
// as deep: the order of the scheme stays. Where a medium is thin enough everywhere, by bounds, nothing is looked at and
// nothing changes.
#pragma once
#include "reference/ray_marcher/plan.h"

namespace airlight::ray_marcher {

constexpr double most_whole = 2;
constexpr double deepest_shaded = 20;  // behind more, 2e-9 of the light, a shadow ray's steps are as they come
constexpr int most_halvings = 40;      // of a step; places in double have no more digits

// Could a step be deep, by the bounds of the media there?
bool may_be_deep(const std::vector<Layer>&, const Options&, const Step&);

// Extinction of a step's media at a ray's parameter [1/m].
Rgb extinction_at(const Plan&, const Ray&, double t, unsigned long long inside);

// Is it, with `before` in front of it, less than `deepest`? `greatest`: extinction, of its ends and its middle.
// `whole`: a step as it was laid, which is left alone up to `most_whole` times as deep: equal steps through a smooth
// medium err less than divided ones.
bool is_deep(const Options&, double deepest, const Rgb& before, const Rgb& greatest, double length, bool whole);

// The steps [begin, end) of a ray with the deep ones divided, appended to `out`; `deepest`: of their Spacing.
void follow_depth(const Plan&, const Ray&, double deepest, const Step* begin, const Step* end, std::vector<Step>& out);

// Is the first step of a shadow ray so deep that its column is to follow the depth?
inline bool starts_deep(const Options& o, double extinction, double length) {
  return extinction * length > deepest_shadow_step(o);
}

// Integral of the varying density over `extent` of a shadow ray [m] by Simpson's rule, whose values the search for deep
// steps has made anyway, from `count` steps on with the deep ones divided. Ends where nothing is left: exp(-750) = 0.
double deep_column(const Layer&, const Options&, const Ray&, Interval extent, int count, long long& steps);

}  // namespace airlight::ray_marcher
