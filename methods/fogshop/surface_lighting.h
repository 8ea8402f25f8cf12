// Light on surfaces, except the unscattered light of point lights: section 4 of Zhou et al. 2007,
// combined as a scene needs it.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "methods/fogshop/environment_lighting.h"
#include "methods/fogshop/next_frame.h"
#include "methods/fogshop/radiance_transfer.h"
#include "methods/fogshop/reflectance_table.h"
#include "methods/fogshop/scattered_reflection.h"
#include "methods/fogshop/stages.h"

namespace airlight::fogshop {

// Null: left out. Shared with the next frame where it holds for that, too.
struct SurfaceLighting {
  std::shared_ptr<const ScatteredReflection> points;        // what the medium scatters of theirs
  std::shared_ptr<const EnvironmentLighting> environment;   // light of the environment, for the air too
  std::shared_ptr<const SurfaceReflectances> reflectances;  // for all that is in harmonics
  std::shared_ptr<const RadianceTransfer> transfer;         // shadows of that
  std::shared_ptr<const DepthTree> depths;                  // Eq. 26

  bool operator==(const SurfaceLighting&) const = default;
};

// `stage` is called after each part that is made, with its name. `before`: of the frame before, with the same options; parts of it are kept
// where their inputs are `unchanged`.
SurfaceLighting make_lighting(const scene::Scene&, const Model&, const Needs&, const SurfaceLighting& before,
                              const Unchanged&, const scene::Execution&,
                              const std::function<void(const std::string&)>& stage);

// B_pv of Eq. 20 in the world's axes, times V_p where there is a visibility, and with what other surfaces reflect where the
// transfer has that: P_p of section 4.3. Requires `reflectances`.
std::vector<Rgb> shadowed_reflectance(const scene::Scene&, const SurfaceLighting&, const SurfacePoint&,
                                      const Vec3& to_view);

// L_p lit by the environment, which there is [W/m^2/sr], Eqs. 26, 27 and 20: what reaches the point unscattered is added to `direct`,
// what the medium scatters onto it, if asked for, to `scattered`. Harmonics cut off at a band may swing below 0: then a
// part is 0.
void reflect_environment(const Model&, const SurfaceLighting&, const SurfacePoint&, const std::vector<Rgb>& reflectance,
                         Rgb& direct, Rgb* scattered);

}  // namespace airlight::fogshop
