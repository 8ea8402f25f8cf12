// Common interface of methods and references: supports, prepare, render.
//
// `prepare` decides what this scene needs and leaves the rest out. Each stage is recorded as kept or
// left out with the reason (`airlight explain` prints it). A stage that is left out costs nothing: no
// call, no dispatch, no entry in the times.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/base/component.h"
#include "scene/base/error.h"
#include "scene/film/film.h"
#include "scene/scene.h"

namespace airlight::scene {
class ContentStore;

// Camera and resolution of a picture. The resolution belongs to the view, so that one Prepared serves
// several resolutions.
struct View {
  Camera camera;
  int width = 0;
  int height = 0;
};
inline View view_of(const Scene& scene) { return {scene.camera, scene.width, scene.height}; }

// How to run: threads (0: as many as the machine has), and a callback with the fraction done in [0, 1], called from any
// thread, that returns false to stop; a stopped render throws Interrupted, or keeps what it has where the renderer says
// so. With a store, what is dear to make is looked for there first, and kept. `layers` are the film's layers that are
// wanted, all where it is nothing: what others a renderer on the CPU makes is its own matter, one on a device leaves them
// there, and with an empty set its times are those of pictures that nobody reads back.
struct Execution {
  int threads = 0;
  std::function<bool(double fraction)> progress;
  const ContentStore* store = nullptr;
  std::optional<std::set<std::string>> layers = {};
};

struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Stage {
  std::string name;
  bool kept;
  std::string reason;  // why it is kept or left out, in this scene
};

struct StageTime {
  std::string name;
  double seconds;
};

struct Rendering {
  Film film;
  std::vector<StageTime> times;            // per kept stage, wall clock; precompute of `prepare` is not in it
  std::map<std::string, double> counters;  // rays, steps, kernel evaluations, ...: what was really done
};

class Prepared {
 public:
  virtual ~Prepared() = default;
  virtual std::vector<Stage> stages() const = 0;
  virtual std::vector<StageTime> prepare_times() const { return {}; }
  virtual Rendering render(const View&, const Execution&) const = 0;
  // Becomes the preparation of the next frame, where lights or media may differ, and keeps what still holds. Wall clock
  // per stage; nothing if it cannot, and is unchanged: then the next frame is prepared anew.
  virtual std::optional<std::vector<StageTime>> next(std::shared_ptr<const Scene>, const Execution&) { return {}; }
};

// Thrown by Renderer::prepare if supports() objects.
class NotSupported : public Error {
 public:
  NotSupported(const std::string& line, std::string reason) : Error(line), reason(std::move(reason)) {}
  std::string reason;  // the first of them
};

class Renderer : public Component {
 public:
  // True: its film is the mean of numbered samples (settings `samples` and `target_error`), with a standard error. Ranges
  // of them can be computed apart, and an Execution's store keeps them.
  virtual bool monte_carlo() const { return false; }
  // Empty: it can render the scene. Else the reasons why not, one line each.
  virtual std::vector<std::string> supports(const Scene&, const Settings&) const = 0;
  // Throws NotSupported if supports() objects.
  void require_support(const Scene&, const Settings&) const;
  // Asks supports() once. The scene is shared because a Prepared may outlive the caller's copy. Throws NotSupported.
  std::unique_ptr<Prepared> prepare(std::shared_ptr<const Scene>, const Settings&, const Execution&) const;

 private:
  // Called for scenes only to which supports() does not object.
  virtual std::unique_ptr<Prepared> prepare_supported(std::shared_ptr<const Scene>, const Settings&,
                                                      const Execution&) const = 0;
};

// Runs body(i) for every i of [0, count) on all threads, reports progress, throws Interrupted if asked to stop, rethrows the
// first exception of a body.
void parallel_for(int count, const Execution&, const std::function<void(int i)>& body);

// True for pixels whose ray touches a light's ball, or whose centre ray passes within it: metrics leave them out.
std::vector<unsigned char> ball_mask(const Scene&, const View&);

}  // namespace airlight::scene
