// One ray, one light, through the same path as a picture.
#pragma once
#include <memory>

#include "methods/fogshop/ray_airlight.h"

namespace fogshop_test {

using namespace airlight;
using namespace airlight::fogshop;

inline Rgb ray_airlight(const Options& options, const Fog& fog, const Point3& light, const Rgb& intensity,
                        const Line& line) {
  Model model;
  model.options = options;
  model.fog = fog;
  model.gaussians = make_arrays(fog.sum.gaussians, options.cull, options.depth_threshold).arrays;
  model.lights.push_back({light, intensity, {}, nullptr});
  double evaluations = 0;
  if (model.paper()) model.lights[0].center_depth = depths_to_centers(model, light, {}, evaluations);
  if (!model.paper() && options.map)
    model.lights[0].map = std::make_unique<LightMap>(model.gaussians, light, options.map_directions, options.map_edges,
                                                     options.erf, scene::Execution{});
  const ViewModel view = make_view_model(model, line.origin, {}, evaluations);
  RayAirlight rays(model, view);
  Rgb airlight;
  double depth;
  rays.evaluate(model.gaussians, line, airlight, depth);
  return airlight;
}

inline Fog grey_fog(const scene::GaussianSum& sum) {
  Fog fog;
  fog.sum = sum;
  return fog;
}

// Nothing approximated but by the number of slices.
inline Options exact(Options::Variant variant, int slices) {
  Options o;
  o.variant = variant;
  o.slices = slices;
  o.extrapolate = false;
  o.boxes = false;
  o.map = false;
  o.depth_threshold = 1e-14;
  return o;
}

}  // namespace fogshop_test
