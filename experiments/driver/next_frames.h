// Frames of a scene of which something moves: a preparation becomes that of the next frame, and is rendered.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/renderer.h"

namespace airlight::experiments {

// An experiment's `moving`: what a frame differs by from the frame before.
struct Moving {
  enum class What {
    camera,       // turns around the middle of finite media, or else on the spot, about the film's upward direction
    lights,       // move by a millimetre and turn by a milliradian
    media,        // move by a millimetre, or where they have no place become a thousandth denser
    fog,          // fogmaps move by a millimetre and turn by 1e-4
    coefficients  // of fogmaps become a thousandth less
  };
  What what = What::lights;
  int frames = 2;      // of which the last is judged: it shows the scene as it is given
  double turn = 1e-3;  // [rad] of a camera, from frame to frame
};

// From its text, "what" to "camera" and so on. Throws Error, which begins with `where`.
Moving read_moving(const std::map<std::string, std::string>& given, const std::string& where);
std::string canonical(const Moving&);

std::string name_of(Moving::What);

// Suns and environments about the y axis; other lights stay.
void turn_lights(scene::Scene&, double angle);

// The scene one frame before, finished. Null if it has nothing that moves so.
std::shared_ptr<const scene::Scene> moved_back(const scene::Scene&, const Moving&);
// One frame before, where all of these move at once. Null if nothing in the scene moves so.
std::shared_ptr<const scene::Scene> all_moved_back(const scene::Scene&, const std::vector<Moving::What>&);

class NextFrames {
 public:
  // Throws NotSupported if nothing in the scene moves so.
  NextFrames(std::shared_ptr<scene::Prepared>, std::shared_ptr<const scene::Scene>, const Moving&);

  // Both throw NotSupported if the preparation cannot become that of the next frame. One without next() holds for any camera.

  // All frames, the last of the scene as it was given.
  scene::Rendering render(const scene::View&, const scene::Execution&);
  // Stages of one frame more, between the last two.
  std::vector<scene::StageTime> again(const scene::View&, const scene::Execution&);

 private:
  using SharedScene = std::shared_ptr<const scene::Scene>;
  scene::Rendering one(const SharedScene&, scene::View, const scene::Execution&);

  std::shared_ptr<scene::Prepared> prepared_;
  Moving moving_;
  std::vector<SharedScene> path_;  // by frame
  std::size_t here_;               // the frame that was rendered last
};

// Frames that go back and forth between a scene and another: each is the one after all that differs between them has moved.
class FramesAfter {
 public:
  // The preparation is of `here`. Views may have another lens and film than the scenes' cameras, which say where they stand.
  FramesAfter(const scene::Renderer&, scene::Settings, std::shared_ptr<const scene::Scene> here,
              std::unique_ptr<scene::Prepared>);

  // The other scene from now on.
  void go_to(std::shared_ptr<const scene::Scene> other, const scene::View&, const scene::Execution&);
  // [s] of next() and the render, or, where there is no next(), of a preparation anew and the render.
  double one(scene::View, const scene::Execution&);
  // A few, after one that warms up, in about `budget` seconds; at least `least`.
  std::vector<double> some(const scene::View&, const scene::Execution&, double budget, std::size_t least = 1);
  bool anew() const { return anew_; }  // some frame to this other scene or back was prepared anew

 private:
  const scene::Renderer& renderer_;
  scene::Settings settings_;
  std::shared_ptr<const scene::Scene> here_, now_, other_;
  std::unique_ptr<scene::Prepared> prepared_;
  bool anew_ = false;
};

struct FrameAfter {
  double seconds = 0;
  bool anew = false;
};
// The median of a few such frames in about `budget` seconds. Nothing where nothing in the scene moves so.
std::optional<FrameAfter> frame_after(Moving::What, const scene::Renderer&, const scene::Settings&,
                                      const std::shared_ptr<const scene::Scene>&, const scene::View&,
                                      const scene::Execution&, double budget);

}  // namespace airlight::experiments
