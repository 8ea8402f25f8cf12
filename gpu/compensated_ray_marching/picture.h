// A scene prepared and drawn on the device: the common part of both variants. Each variant computes the smoke's light
// in its own file: grid_picture.cpp and paper_picture.cpp.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/compensated_ray_marching/map_projection.h"
#include "gpu/compensated_ray_marching/marched_smoke.h"
#include "gpu/compensated_ray_marching/surroundings.h"
#include "gpu/timer.h"
#include "methods/compensated_ray_marching/environment_bands.h"
#include "methods/compensated_ray_marching/warm_start.h"

namespace airlight::gpu::compensated_ray_marching {

using airlight::compensated_ray_marching::Options;
using airlight::compensated_ray_marching::Solution;

// Why the device does not draw a scene; empty: it does.
std::vector<std::string> unsupported_on_device(const scene::Scene&, const Options&);

class Picture : public scene::Prepared {
 public:
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const scene::View&, const scene::Execution&) const override;
  // Lights alone: the smoke, its depths and the last multiple scattering stay on the device.
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene>,
                                                    const scene::Execution&) override;
  // Null where there is no solution to begin with: then the next frame is prepared anew. A frame without smoke passes on what it was given.
  std::unique_ptr<Picture> in_other_smoke(std::shared_ptr<const scene::Scene>, const scene::Execution&) const;

 protected:
  // Iterations begin with the last solution, if there is one.
  Picture(std::shared_ptr<const scene::Scene>, const Options&, std::string settings, Solution last);
  // Harmonics of environments, maps projected on the device.
  airlight::compensated_ray_marching::EnvironmentBands bands(int order);
  // Programs of the march and the layers.
  void begin_march();
  Buffer& of_pixels(const char* name, const scene::View& view, std::size_t bytes) const {
    return compensated_ray_marching::of_pixels(frame_, name, view, bytes);
  }

  // The light of `scene_`: stages with their times.
  virtual std::vector<scene::StageTime> light(const scene::Execution&) = 0;
  virtual bool fits(const scene::Scene&) const = 0;  // may its lights be the next ones?
  virtual Solution solution() const = 0;
  // Work of a frame: source radiance towards the camera, in stages of the frame's timer; bindings for the program of
  // the march; surfaces.
  virtual void find_source(const scene::View&) const = 0;
  virtual void bind_source(Program&) const = 0;
  virtual void light_surfaces(const scene::View&) const = 0;
  // Texts for `explain`: how single and multiple scattering are done, or why not; the volume pass, if
  // there is one; the light on surfaces.
  virtual std::string single() const = 0;
  virtual std::pair<bool, std::string> multiple() const = 0;
  virtual std::optional<std::string> volume_pass() const { return std::nullopt; }
  virtual std::string surfaces_lit() const = 0;
  virtual void count(std::map<std::string, double>& counters) const = 0;

  std::shared_ptr<const scene::Scene> first_, scene_;  // the first has the smoke
  std::string lit_by_ = scene_->light_hash;            // what the last frame was lit by
  Options options_;
  std::string settings_;
  Solution last_;                                                        // of a frame before, where this one has none
  std::optional<airlight::compensated_ray_marching::SmokeField> smoke_;  // nothing where no medium extinguishes
  bool scatters_ = false;                                                // the smoke, something of the light
  std::unique_ptr<MapProjection> projection_;
  Point3 middle_ = Point3::Zero();  // of the smoke
  double slice_ = 0;                // [m] across
  Context& context_;
  std::unique_ptr<Surroundings> surroundings_;
  std::unique_ptr<SmokeDensity> density_;
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;

 private:
  void march(const scene::View&) const;
  void compose(const scene::View&) const;
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && smoke_; }

  Program *ranges_ = nullptr, *march_ = nullptr, *composition_ = nullptr;
};

// A picture of the variant that the options name.
std::unique_ptr<Picture> prepare_picture(std::shared_ptr<const scene::Scene>, const Options&, std::string settings,
                                         Solution last, const scene::Execution&);
std::unique_ptr<Picture> prepare_grid_picture(std::shared_ptr<const scene::Scene>, const Options&, std::string settings,
                                              Solution last, const scene::Execution&);
std::unique_ptr<Picture> prepare_paper_picture(std::shared_ptr<const scene::Scene>, const Options&,
                                               std::string settings, Solution last, const scene::Execution&);

// Adds times of stages; the same name again adds up.
void append(std::vector<scene::StageTime>& times, const std::vector<scene::StageTime>& more);

}  // namespace airlight::gpu::compensated_ray_marching
