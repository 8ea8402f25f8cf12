// Plan of an experiment on one scene, before anything is rendered or written.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/driver/row.h"
#include "scene/base/content_store.h"
#include "scene/renderer.h"

namespace airlight::experiments {

struct PlannedRow {
  const MethodCase* method = nullptr;  // of the experiment, which must stay where it is
  const scene::Renderer* renderer = nullptr;
  scene::Settings settings;
  std::shared_ptr<const scene::Scene> scene;  // with its media converted, where the method asks for that
  std::string refused;                        // why its media cannot be converted, if they cannot
  Row row;                                    // what is known before it is rendered, its key above all
};

struct PlannedScene {
  std::shared_ptr<const scene::Scene> scene;
  const scene::Renderer* reference = nullptr;  // null: nothing is compared
  std::optional<scene::Settings> reference_settings;
  std::filesystem::path committed;  // the reference's film, there or not; empty: none is asked for
  std::vector<PlannedRow> rows;     // in the order of the experiment's methods
};

// Loads the scene; no rows. Throws Error (file, line, what was found) for a scene or override that is no good.
PlannedScene plan_reference(const Experiment&, const SceneCase&);

// The key of the scene's reference (reference_cache.h), and whether its film is committed or lies in the store.
std::string reference_key(const PlannedScene&);
bool is_there(const PlannedScene&, const scene::ContentStore&);

// Plans a scene with its rows. A row's key is the content of all that its figures and times depend on: scene, method,
// reference, metrics, rule of timing; sources, compiler and libraries of the program; processor and threads; the
// device, and its shaders if they come from AIRLIGHT_SHADERS. Throws Error (file, line, what was found) for an invalid
// scene or override. Converted media are kept in the store.
PlannedScene plan_scene(const Experiment&, const SceneCase&, const scene::ContentStore&);
// Plans a scene that is loaded, such as one picture of a sequence.
PlannedScene plan_scene(const Experiment&, const SceneCase&, std::shared_ptr<const scene::Scene>,
                        const scene::ContentStore&);

// A row as the file describes it, with the content hash of its scene.
Row row_of(const SceneCase&, const MethodCase&, const scene::Settings&, const std::string& scene_hash);

// Keys of a row whose names, settings and hashes are known.
void set_keys(const Experiment&, const MethodCase&, const scene::Component&, Row&);

// Pixels of the view whose ray sees more than 1e-3 of the media, from the media themselves.
std::vector<unsigned char> foreground_of(const scene::Scene&, const scene::View&);

}  // namespace airlight::experiments
