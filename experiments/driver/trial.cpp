#include "experiments/driver/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plan.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr int most_pixels = 8;  // a side

// Uses the fewest samples that give the same layers: samples beyond whole blocks decide whether there
// are equal batches.
scene::Settings short_settings(const scene::Renderer& renderer, Pairs given, const scene::Settings& whole) {
  if (renderer.monte_carlo()) {
    const long long samples = whole.integer("samples");
    if (samples > 128) given["samples"] = std::to_string(64 + samples % 64);
    given["target_error"] = "0";
  }
  return scene::Settings(renderer.settings(), given, renderer.name());
}

class Trial {
 public:
  Trial(const Experiment& e, const SceneCase& c, const PlannedScene& planned)
      : e_(e), planned_(planned), view_(scene::view_of(*planned.scene)) {
    view_.width = std::min(view_.width, most_pixels);
    view_.height = std::min(view_.height, most_pixels);
    if (!planned.reference) return;
    reference_ = render(*planned.reference, planned.scene, reference_of(e, c).settings, *planned.reference_settings);
    require_finite(reference_, "reference " + planned.reference->name());
    reference_.layer(e.layer);
  }

  void method(const PlannedRow& p) const {
    if (!p.refused.empty()) return;
    scene::Film film;
    try {
      film = render(*p.renderer, p.scene, p.method->settings, p.settings);
    } catch (const Unavailable&) {
      return;  // the row will say so
    } catch (const scene::NotSupported&) {
      return;
    }
    require_finite(film, p.method->name);
    film.layers[e_.layer] = film.layer(p.method->layer);
    if (planned_.reference)
      compare(e_, *p.method, film, reference_, reference_, {{}, foreground_of(*planned_.scene, view_)});
  }

 private:
  scene::Film render(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& scene,
                     const Pairs& given, const scene::Settings& whole) const {
    check_interrupted();
    const scene::Execution execution = quiet_execution(e_.timing.threads);
    const auto prepared = renderer.prepare(scene, short_settings(renderer, given, whole), execution);
    return prepared->render(view_, execution).film;
  }

  const Experiment& e_;
  const PlannedScene& planned_;
  scene::View view_;
  scene::Film reference_;
};

void check_scene(const Experiment& e, const SceneCase& c, const Journal& finished, bool trials,
                 const scene::ContentStore& store, std::set<const MethodCase*>& tried) {
  const PlannedScene planned = plan_scene(e, c, store);
  std::vector<const PlannedRow*> open;
  for (const PlannedRow& p : planned.rows)
    if (!finished.find(p.row.key)) open.push_back(&p);
  if (open.empty() || !trials) return;
  try {
    const Trial trial(e, c, planned);
    for (const PlannedRow* p : open)
      if (tried.insert(p->method).second) trial.method(*p);
  } catch (const Unavailable&) {
    return;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", c.name, error.what()), error.exit_code());
  }
}

}  // namespace

void try_pictures(const Experiment& e, const RunOptions& options) {
  const Journal finished(journal_file(options.folders, e), options.resume);
  std::set<const MethodCase*> tried;
  const scene::ContentStore store(options.folders.cache, say);
  for (const SceneCase& c : e.scenes) check_scene(e, c, finished, options.trials, store, tried);
}

}  // namespace airlight::experiments
