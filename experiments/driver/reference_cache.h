// Reference images, computed once: references/<key>.exr in the store (results/cache). Samples of a Monte Carlo renderer
// are kept as well (results/cache/samples): a reference with fewer samples is refined, and one that was interrupted goes
// on where it was; its samples are always exactly those asked for.
//
// The key is the content of scene, renderer, settings and of the sources of scene/ and reference/, the compiler, and
// where there is one the device and its shaders: another program that computes the same is served, a changed reference
// is not. A damaged or half-copied file is computed anew.
#pragma once
#include <memory>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments {

struct Reference {
  scene::Film film;
  std::string key;
  double seconds = 0;  // that it took when it was computed, all its samples
  bool cached = false;
};

std::string reference_key(const scene::Scene&, const scene::Renderer&, const scene::Settings&);

// Through the store of the execution. Throws NotSupported, Interrupted if stopped.
Reference reference_for(std::shared_ptr<const scene::Scene>, const scene::Renderer&, const scene::Settings&,
                        const scene::Execution&);

}  // namespace airlight::experiments
