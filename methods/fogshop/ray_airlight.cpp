#include "methods/fogshop/ray_airlight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

LightFromRay light_from_ray(const Point3& light, const Line& line) {
  const Vec3 offset = light - line.origin;
  return {offset.dot(line.direction), line.direction.cross(offset).norm()};
}

}  // namespace

ViewModel make_view_model(const Model& model, const Point3& view, const scene::Execution& execution,
                          double& evaluations) {
  ViewModel result;
  if (!model.paper() || model.scattered_lights() == 0) return result;
  const std::vector<double> to_center = depths_to_centers(model, view, execution, evaluations);
  Crossings crossings;
  for (const LightModel& light : model.lights) {
    PaperLight paper;
    paper.position = light.position;
    paper.softness = model.options.source_radius * model.options.source_radius;
    paper.g = model.fog.g;
    paper.exponent.resize(model.gaussians.count);
    for (int i = 0; i < model.gaussians.count; ++i) paper.exponent[i] = -(light.center_depth[i] + to_center[i]);
    result.lights.push_back(std::move(paper));
    result.shadow.push_back(gaussian_depth(model, light.position, view, crossings, evaluations));
  }
  return result;
}

void RayAirlight::evaluate(const GaussianArrays& near, const Line& line, Rgb& airlight, double& depth) {
  cross(near, line, model_.options.erf, crossings_);
  crossed += crossings_.count;
  evaluations += 2.0 * crossings_.count;
  if (model_.paper()) {
    depth = whole_depths(crossings_, line.length, model_.options.erf);
    if (model_.noise) {
      bent_depths(near, line, *model_.noise, model_.options.erf, crossings_);
      evaluations += 2.0 * crossings_.count;
      depth = std::accumulate(crossings_.whole.begin(), crossings_.whole.begin() + crossings_.count, 0.0);
    }
  } else {
    if (model_.noise) bend(near, line, *model_.noise, crossings_);
    depth = total_depth(crossings_, line.length, model_.options.erf);
  }
  if (model_.fog.sum.constant > 0) depth += model_.fog.sum.constant * line.length;
  airlight.setZero();
  if (model_.sky) airlight = sky(line) * model_.fog.albedo;
  if (model_.scattered_lights() == 0) return;
  seen_.clear();
  for (const LightModel& light : model_.lights) seen_.push_back(light_from_ray(light.position, line));
  Rgb points;
  if (model_.gaussians.count == 0)
    points = constant_alone(line.length);
  else
    points = model_.paper() ? paper(near, line) : slices(near, line);
  airlight += points * model_.fog.albedo;
}

// Slices of equal length over what the line meets; the environment's light is taken in their middle.
Rgb RayAirlight::sky(const Line& line) {
  const Interval range = stretch(line);
  Rgb sum = Rgb::Zero();
  if (range.empty()) return sum;
  const int slices = model_.options.slices;
  constexpr int vector = GaussianArrays::padding;
  t_.assign((slices + vector) / vector * vector, range.hi);
  view_depth_.resize(t_.size());
  for (int k = 0; k < slices; ++k) t_[k] = range.lo + range.length() * k / slices;
  depths_at(crossings_, t_.data(), int(t_.size()), view_depth_.data(), model_.options.erf);
  evaluations += double(crossings_.count) * (slices + 1);
  for (int k = 0; k < slices; ++k) {
    // Not a difference of transmittances, which leaves nothing of a thin medium.
    const double depth = std::max(view_depth_[k + 1] - view_depth_[k], 0.0);
    Rgb light = model_.sky->at(line.origin + 0.5 * (t_[k] + t_[k + 1]) * line.direction);
    for (int c = 0; c < 3; ++c)
      light[c] *= std::exp(-view_depth_[k] * model_.fog.extinction_ratio[c]) *
                  -std::expm1(-depth * model_.fog.extinction_ratio[c]);
    sum += light;
  }
  return sum;
}

// L_a^h per channel [W/m^2/sr] for 1 W/sr.
Rgb RayAirlight::homogeneous(const LightFromRay& light, double length) const {
  Rgb result;
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && model_.fog.grey()) {
      result[c] = result[0];
      continue;
    }
    const double beta = model_.fog.sum.constant * model_.fog.extinction_ratio[c];
    result[c] = model_.f_table ? model_.f_table->homogeneous_airlight(light, length, beta)
                               : softened_homogeneous_airlight(light, length, beta, model_.options.source_radius);
  }
  return model_.fog.one_albedo() ? result : Rgb(model_.fog.constant_colour * result);
}

Rgb RayAirlight::constant_alone(double length) const {
  Rgb airlight = Rgb::Zero();
  for (std::size_t k = 0; k < model_.lights.size(); ++k)
    airlight += model_.lights[k].intensity * homogeneous(seen_[k], length);
  return airlight;
}

// Section 5.3: L_0 by Eq. 17, then every Gaussian that the ray meets.
Rgb RayAirlight::paper(const GaussianArrays& near, const Line& line) {
  Rgb airlight = Rgb::Zero();
  for (std::size_t k = 0; k < model_.lights.size(); ++k) {
    Rgb sum = Rgb::Zero();
    add_gaussian_terms(near, crossings_, line, view_.lights[k], model_.options.erf, model_.fog.extinction_ratio,
                       coloured(), sum);
    evaluations += 2.0 * crossings_.count;
    if (!coloured()) sum = Rgb::Constant(sum[0]);
    if (model_.fog.sum.constant > 0)
      sum += (-model_.fog.extinction_ratio * view_.shadow[k]).exp() * homogeneous(seen_[k], line.length);
    airlight += model_.lights[k].intensity * sum;
  }
  return airlight;
}

// The part of the ray that is sliced; empty if there is nothing to see.
Interval RayAirlight::stretch(const Line& line) const {
  Interval reach;  // of the Gaussians along the line
  for (int i = 0; i < crossings_.count; ++i) {
    reach.lo = std::min(reach.lo, crossings_.middle[i] - crossings_.chord[i]);
    reach.hi = std::max(reach.hi, crossings_.middle[i] + crossings_.chord[i]);
  }
  const double constant = model_.fog.sum.constant;
  if (!(constant > 0)) return intersect(reach, Interval{0, line.length});
  // With a constant every part of the ray shines. The slices cover it until long after the last Gaussian and the
  // lights, or until 40 more depths (of the clearest colour) than the straight way from the light have been passed; the
  // rest of the ray is homogeneous and has a closed form.
  const double clearest = (model_.fog.extinction_ratio > 0).select(model_.fog.extinction_ratio, 1.0).minCoeff();
  double beyond = std::max(0.0, reach.hi), dark = 0;
  for (const LightFromRay& light : seen_) {
    beyond = std::max(beyond, std::abs(light.along) + light.h);
    const double d_sv = std::hypot(light.along, light.h), c = d_sv + 40 / (constant * clearest);
    dark = std::max(dark, 0.5 * (c - d_sv) * (c + d_sv) / (c - light.along));
  }
  return {0, std::min({line.length, beyond * (1 + model_.options.slices / 16.0), dark})};
}

// From the edges and depths at hand; per channel, for 1 W/sr.
Rgb RayAirlight::sum_of_slices(const LightFromRay& light, bool separate) {
  const Options& o = model_.options;
  const double* const scattering[] = {scattering_[0].data(), scattering_[1].data(), scattering_[2].data()};
  const SliceEdges edges{t_.data(), view_depth_.data(), light_depth_.data(), separate ? scattering : nullptr};
  Rgb sum = Rgb::Zero(), half = Rgb::Zero();
  sum_slices(edges, o.slices, light, o.source_radius, model_.fog.g, model_.fog.extinction_ratio, coloured(),
             slice_scratch_, sum, o.extrapolate ? &half : nullptr);
  // The error is c K^-2 + O(K^-4): with half the slices it is four times as large.
  if (o.extrapolate) sum = (sum + (sum - half) / 3).max(0.0);
  return coloured() ? sum : Rgb::Constant(sum[0]);
}

// Depths from a light to points of the ray, without the constant; `t` is padded to whole vectors.
void RayAirlight::depths_from_light(const LightModel& light, const Line& line, const Interval& range,
                                    const std::vector<double>& t, int count, std::vector<double>& depth) {
  if (model_.clear_ways) {
    std::fill_n(depth.begin(), count, 0.0);
    return;
  }
  if (light.map) {
    light.map->depths(line, t.data(), count, depth.data());
    return;
  }
  near_triangle(model_.gaussians, light.position, line, range.lo, range.hi, places_);
  depths_from_point(subset(model_.gaussians, places_), light.position, line, t.data(), count, depth.data(),
                    model_.options.erf);
}

Rgb RayAirlight::slices(const GaussianArrays& near, const Line& line) {
  const double constant = model_.fog.sum.constant;
  const Options& o = model_.options;
  const int slices = o.slices;
  const bool separate = !model_.fog.one_albedo();
  const Interval range = stretch(line);
  Rgb airlight = Rgb::Zero();
  if (range.empty()) return airlight;

  // The first edge is on its own, so that a multiple of 8 slices fills whole vectors.
  const auto padded = [](int n) { return (n + GaussianArrays::padding - 1) & -GaussianArrays::padding; };
  t_.assign(slice_room(slices), range.hi);
  view_depth_.resize(t_.size());
  light_depth_.resize(t_.size());
  place_edges(range.lo, range.hi, seen_, o.boxes ? &crossings_ : nullptr, slices, scratch_, t_.data());
  if (separate)
    for (auto& channel : scattering_) channel.assign(t_.size(), 0.0);
  if (separate) {
    double* const scattering[] = {scattering_[0].data(), scattering_[1].data(), scattering_[2].data()};
    scattering_depths_at(crossings_, near, t_.data(), padded(slices + 1), view_depth_.data(), scattering, o.erf);
  } else {
    view_depth_[0] = range.lo > 0 ? total_depth(crossings_, range.lo, o.erf) : 0;
    if (!(range.lo > 0)) evaluations -= crossings_.count;
    depths_at(crossings_, &t_[1], padded(slices), &view_depth_[1], o.erf);
  }
  evaluations += double(crossings_.count) * (slices + 1);
  for (int k = 0; k <= slices; ++k) view_depth_[k] += constant * t_[k];
  for (int c = 0; separate && c < 3; ++c)
    for (int k = 0; k <= slices; ++k) scattering_[c][k] += model_.fog.constant_colour[c] * constant * t_[k];

  for (std::size_t l = 0; l < model_.lights.size(); ++l) {
    const LightModel& light = model_.lights[l];
    depths_from_light(light, line, range, t_, padded(slices + 1), light_depth_);
    if (!light.map && !model_.clear_ways) evaluations += 2.0 * double(places_.size()) * (slices + 1);
    const double last_shadow = light_depth_[slices];
    const double h2 = seen_[l].h * seen_[l].h;
    for (int k = 0; constant > 0 && k <= slices; ++k) {
      const double x = t_[k] - seen_[l].along;
      light_depth_[k] += constant * std::sqrt(x * x + h2);
    }
    Rgb sum = sum_of_slices(seen_[l], separate);
    if (constant > 0 && range.hi < line.length)
      sum += (-model_.fog.extinction_ratio * (view_depth_[slices] + last_shadow)).exp() *
             homogeneous({seen_[l].along - range.hi, seen_[l].h}, line.length - range.hi);
    airlight += light.intensity * sum;
  }
  return airlight;
}

}  // namespace airlight::fogshop
