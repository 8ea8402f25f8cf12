// Pictures of a flow while it is simulated: a scene whose first medium that extinguishes has the flow's density.
#pragma once
#include <memory>
#include <string>

#include "scene/base/settings.h"
#include "scene/flow/flow.h"
#include "scene/renderer.h"

namespace airlight::experiments {

// The scene with this density in its first medium that extinguishes. Throws Error where it has none.
std::shared_ptr<const scene::Scene> scene_with_smoke(const scene::Scene&, const scene::DensityField&);

class FlowPictures {
 public:
  // Keeps scene, renderer and settings by reference. Throws Error where no medium of the scene extinguishes.
  FlowPictures(const scene::Scene&, const scene::Renderer&, const scene::Settings&, double exposure, int threads);

  // Draws the flow into a PNG file. If flow and renderer are both legendre_fluids_gpu, the picture is drawn from the
  // device's data. Else the renderer keeps what does not depend on the density, if it can. Throws NotSupported if the
  // renderer cannot show the flow's density, Error if the file cannot be written.
  void draw(const scene::Flow&, const std::string& png);
  // Draws a frame of an earlier run, of which only the density is known. Errors as above.
  void draw(const scene::DensityField&, const std::string& png);

  int on_device() const { return on_device_; }  // pictures that did not leave it before they were done
  double seconds() const { return seconds_; }   // of all

 private:
  void write(const std::string& png) const;
  void prepare(const scene::DensityField&);

  const scene::Scene& scene_;
  const scene::Renderer& renderer_;
  const scene::Settings& settings_;
  double exposure_, seconds_ = 0;
  scene::Execution execution_;
  std::unique_ptr<scene::Prepared> prepared_;
  int on_device_ = 0;
};

}  // namespace airlight::experiments
