// Airlight and optical depth of single view rays, by the paper's formulas or by slices.
#pragma once
#include <array>

#include "methods/fogshop/edges.h"
#include "methods/fogshop/model.h"
#include "methods/fogshop/paper_ray.h"
#include "methods/fogshop/slices.h"

namespace airlight::fogshop {

// Values that depend on the view point but not on the ray: paper variant only.
struct ViewModel {
  std::vector<PaperLight> lights;
  std::vector<double> shadow;  // T(s,v) of the Gaussians alone, by light [-], at extinction ratio 1
};
ViewModel make_view_model(const Model&, const Point3& view, const scene::Execution&, double& evaluations);

// Evaluates rays one after another; one per thread.
class RayAirlight {
 public:
  RayAirlight(const Model& model, const ViewModel& view) : model_(model), view_(view) {}

  // `near` holds every Gaussian that the ray may meet. Sets the airlight [W/m^2/sr] with albedo and intensities, and
  // the optical depth to the end of the line [-] for an extinction ratio of 1. The line may be infinite.
  void evaluate(const GaussianArrays& near, const Line&, Rgb& airlight, double& depth);

  double evaluations = 0;  // of the error function
  double crossed = 0;      // pairs of ray and Gaussian

 private:
  Rgb paper(const GaussianArrays& near, const Line&);
  Rgb slices(const GaussianArrays& near, const Line&);
  Rgb constant_alone(double length) const;  // of a medium without Gaussians, where both variants are exact
  Rgb homogeneous(const LightFromRay&, double length) const;
  Rgb sky(const Line&);  // by Model::sky
  Interval stretch(const Line&) const;
  bool coloured() const { return !model_.fog.grey() || !model_.fog.one_albedo(); }
  Rgb sum_of_slices(const LightFromRay&, bool separate);
  void depths_from_light(const LightModel&, const Line&, const Interval& range, const std::vector<double>& t, int count,
                         std::vector<double>& depth);

  const Model& model_;
  const ViewModel& view_;
  Crossings crossings_;
  EdgeScratch scratch_;
  SliceScratch slice_scratch_;
  std::vector<LightFromRay> seen_;
  std::vector<int> places_;
  std::vector<double> t_, view_depth_, light_depth_;
  // Scattering of the medium up to an edge, per channel [-], at extinction ratio 1; unused if it equals the extinction.
  std::array<std::vector<double>, 3> scattering_;
};

}  // namespace airlight::fogshop
