// Decides what the next frame keeps of the previous frame. Values are compared, not the objects that hold them: a
// medium that was copied and not changed counts as unchanged.
#pragma once
#include "methods/fogshop/model.h"

namespace airlight::fogshop {

// Inputs of tables that two frames with the same settings have in common, bit by bit.
struct Unchanged {
  bool gaussians = false;     // all that their depths along lines depend on: places, widths, amplitudes, radii
  bool fog = false;           // these, and the constant, colours of extinction and scattering, the phase function
  bool surfaces = false;      // shapes and materials
  bool environments = false;  // all environment lights
};
Unchanged unchanged(const scene::Scene& before, const Model& model_before, const scene::Scene& now, const Model&);

// True if the frames differ in their cameras alone, so that everything prepared serves both. Scenes must have been finished.
bool camera_alone_moved(const scene::Scene& before, const scene::Scene& now);

// The light of the frame before that stood at this position; null if none did. Its intensity may be another.
const LightModel* light_at(const Model&, const Point3& position);

}  // namespace airlight::fogshop
