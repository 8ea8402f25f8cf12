// A scene file of which a browser changes single values: the camera, lights, coefficients of media.
#pragma once
#include <toml++/toml.h>

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "scene/scene.h"

namespace airlight::experiments::serve {

// Values are overrides as in `--override`, and mean what they mean there. They are read without reading the file or its assets again, but for
// another frame of a sequence.
class SceneSource {
 public:
  // Throws Error.
  explicit SceneSource(const std::string& file);

  const std::string& file() const { return file_; }
  // Throws Error (one line) for a path that may not be changed, and for a value that a scene file may not have.
  std::shared_ptr<const scene::Scene> with(const scene::Overrides&) const;
  // The scene file with the values changed. Comments are lost; names of other files are as they were.
  std::string text(const scene::Overrides&) const;

  // First and last of the frames that a medium of a sequence has beside the file; nothing for other media.
  std::optional<std::pair<long long, long long>> frames(std::size_t medium) const;
  long long frame(std::size_t medium) const { return whole_["medium"][medium]["frame"].value_or(0LL); }

  // The camera's target and upward direction as the file gives them.
  Point3 look_at() const { return look_at_; }
  Vec3 up() const { return up_; }

 private:
  std::shared_ptr<const scene::Scene> changed(const scene::Overrides&) const;
  void read_frames(const std::set<std::size_t>& media, const scene::Overrides&, scene::Scene&) const;

  std::string file_, folder_, text_;
  std::shared_ptr<const scene::Scene> scene_;
  toml::table whole_;   // the file
  toml::table values_;  // its camera, lights and media, without what is large or names a file
  Point3 look_at_;
  Vec3 up_;
};

// May a browser change the value at this path? "camera.position", "light.0.intensity", "medium.1.sigma_t".
bool may_change(const std::string& path);

}  // namespace airlight::experiments::serve
