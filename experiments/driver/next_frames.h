// Frames of a scene of which something moves: a preparation becomes that of the next frame, and is rendered.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scene/renderer.h"

namespace airlight::experiments {

// What a method's `moving` may say: lights to and fro by a millimetre; fogmaps likewise, turned by 1e-4 as well; or all
// coefficients of fogmaps a thousandth less and back.
std::vector<std::string> what_may_move();

class NextFrames {
 public:
  // Throws NotSupported if nothing in the scene moves so.
  NextFrames(std::shared_ptr<scene::Prepared>, std::shared_ptr<const scene::Scene>, const std::string& moving);

  // Both throw NotSupported if the preparation cannot become that of the next frame.

  // Two frames, the second of the scene as it was given.
  scene::Rendering render(const scene::View&, const scene::Execution&);
  // Stages of one frame more.
  std::vector<scene::StageTime> again(const scene::View&, const scene::Execution&);

 private:
  scene::Rendering one(const std::shared_ptr<const scene::Scene>&, const scene::View&, const scene::Execution&);

  std::shared_ptr<scene::Prepared> prepared_;
  std::shared_ptr<const scene::Scene> here_, there_;
  std::string moving_;
};

}  // namespace airlight::experiments
